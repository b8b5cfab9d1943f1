// Bundles the page into ../page.html: one file, scripts and styles inside. With --check it only says whether that
// file is what would be made.

import { gzipSync } from 'node:zlib';
import { readFileSync, writeFileSync } from 'node:fs';
import { fileURLToPath } from 'node:url';
import { build, transform } from 'esbuild';

const here = (name) => fileURLToPath(new URL(name, import.meta.url));
const read = (name) => readFileSync(here(name), 'utf8');
const LIMIT = 250_000; // Bytes of the page after gzip.
const MODEL = '<!--MODEL-->'; // `--html` puts the model here; the text must stand exactly once.

const { outputFiles } = await build({
  entryPoints: [here('src/main.js')],
  bundle: true,
  minify: true,
  format: 'iife',
  target: ['chrome110', 'firefox115', 'safari16.4'],
  legalComments: 'none',
  charset: 'utf8',
  write: false,
});
const script = outputFiles[0].text.trim().replaceAll('</script', '<\\/script').replaceAll('<!--', '<\\!--');
const style = (await transform(read('style.css'), { loader: 'css', minify: true })).code.trim();

const licenses = ['three', 'three-mesh-bvh'].map((name) => {
  const { version } = JSON.parse(read(`node_modules/${name}/package.json`));
  return `${name} ${version}\n\n${read(`node_modules/${name}/LICENSE`).trim()}`;
});
const notice = `<!--\nThis page holds parts of these libraries:\n\n${licenses.join('\n\n')}\n-->`;

const page = read('template.html')
  .replace('<!--LICENSES-->', () => notice)
  .replace('/*STYLE*/', () => style)
  .replace('/*SCRIPT*/', () => script);

if (page.split(MODEL).length !== 2) throw new Error(`the text ${MODEL} must stand exactly once in the page`);
const address = /https?:\/\/(?!www\.w3\.org\/)[\w.-]+/g;
const packed = gzipSync(page, { level: 9 }).length;
if (packed > LIMIT) throw new Error(`the page has ${packed} bytes after gzip, more than ${LIMIT}`);

if (process.argv.includes('--check')) {
  if (read('../page.html') !== page) {
    console.error('page.html is not what its sources make: run `npm run build`');
    process.exit(1);
  }
  console.log(`page.html is as its sources make it: ${page.length} characters, ${packed} bytes after gzip`);
} else {
  writeFileSync(here('../page.html'), page);
  console.log(`page.html: ${page.length} characters, ${packed} bytes after gzip`);
  const named = [...new Set(script.match(address) ?? [])];
  if (named.length) console.log(`addresses in its text (messages of libraries): ${named.join(' ')}`);
}
