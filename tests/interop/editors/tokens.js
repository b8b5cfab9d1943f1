// node tokens.js LOFT GRAMMAR SCRIPT…: colours every script by the TextMate grammar, with the engine that VS Code uses,
// and compares it with what the interpreter itself says the same letters are (semantic tokens of `loft lsp`).
import { spawn } from "node:child_process";
import { readFileSync } from "node:fs";
import { createRequire } from "node:module";
import path from "node:path";
import { pathToFileURL } from "node:url";

const require = createRequire(path.join(process.cwd(), "package.json"));
const oniguruma = require("vscode-oniguruma");
const textmate = require("vscode-textmate");

const [loft, grammarPath, ...scripts] = process.argv.slice(2);

async function grammar() {
  const wasm = readFileSync(path.join(path.dirname(require.resolve("vscode-oniguruma")), "onig.wasm"));
  await oniguruma.loadWASM(wasm.buffer.slice(wasm.byteOffset, wasm.byteOffset + wasm.length));
  const onigLib = { createOnigScanner: (all) => new oniguruma.OnigScanner(all), createOnigString: (s) => new oniguruma.OnigString(s) };
  const loadGrammar = async () => textmate.parseRawGrammar(readFileSync(grammarPath, "utf8"), "loft.json");
  return new textmate.Registry({ onigLib: Promise.resolve(onigLib), loadGrammar }).loadGrammar("source.loft");
}

/** Requests to a running language server. */
class Server {
  constructor() {
    this.child = spawn(loft, ["lsp"], { stdio: ["pipe", "pipe", "inherit"] });
    this.next = 0;
    this.answers = new Map();
    this.buffer = Buffer.alloc(0);
    this.child.stdout.on("data", (data) => {
      this.buffer = Buffer.concat([this.buffer, data]);
      for (let end; (end = this.buffer.indexOf("\r\n\r\n")) >= 0; ) {
        const length = Number(/Content-Length: (\d+)/.exec(this.buffer.toString("latin1", 0, end))[1]);
        if (this.buffer.length < end + 4 + length) break;
        const message = JSON.parse(this.buffer.toString("utf8", end + 4, end + 4 + length));
        this.buffer = this.buffer.subarray(end + 4 + length);
        this.answers.get(message.id)?.(message.result);
      }
    });
  }
  send(message) {
    const text = JSON.stringify({ jsonrpc: "2.0", ...message });
    this.child.stdin.write(`Content-Length: ${Buffer.byteLength(text)}\r\n\r\n${text}`);
  }
  tell(method, params) {
    this.send({ method, params });
  }
  ask(method, params) {
    const id = ++this.next;
    this.send({ id, method, params });
    return new Promise((done) => this.answers.set(id, done));
  }
}

const CLASSES = [
  ["comment", /^comment/],
  ["number", /^constant\.numeric|^keyword\.other\.unit/],
  ["constant", /^constant\.language/],
  ["keyword", /^keyword\.(declaration|control|operator\.word)/],
  ["function", /^(entity\.name|support)\.function/],
  ["name", /^variable|^support\.type\.property-name/],
  ["operator", /^keyword\.operator|^punctuation\.loft/],
  ["string", /^string|^constant\.character|^invalid|^punctuation\.section|^meta\.interpolation/],
];
const KINDS = { variable: "name", property: "name", enumMember: "constant" };

function classOf(scopes) {
  for (const scope of scopes.toReversed()) {
    const found = CLASSES.find(([, pattern]) => pattern.test(scope));
    if (found) return found[0];
  }
  return "nothing";
}

/** What each letter of each line is by the grammar. */
function byGrammar(rules, lines) {
  let stack = textmate.INITIAL;
  return lines.map((line) => {
    const { tokens, ruleStack } = rules.tokenizeLine(line, stack);
    stack = ruleStack;
    const classes = new Array(line.length);
    for (const token of tokens) classes.fill(classOf(token.scopes), token.startIndex, Math.min(token.endIndex, line.length));
    return classes;
  });
}

let wrong = 0;
let compared = 0;
const rules = await grammar();
const server = new Server();
const { capabilities } = await server.ask("initialize", { capabilities: {}, processId: null, rootUri: null });
const legend = capabilities.semanticTokensProvider.legend.tokenTypes;
server.tell("initialized", {});
for (const script of scripts) {
  const text = readFileSync(script, "utf8").replace(/^\uFEFF/, "");
  const uri = pathToFileURL(path.resolve(script)).href;
  server.tell("textDocument/didOpen", { textDocument: { uri, languageId: "loft", version: 1, text } });
  const { data } = await server.ask("textDocument/semanticTokens/full", { textDocument: { uri } });
  server.tell("textDocument/didClose", { textDocument: { uri } });
  const lines = text.split(/\r?\n/);
  const found = byGrammar(rules, lines);
  let [line, column, said] = [0, 0, 0];
  for (let k = 0; k < data.length; k += 5) {
    column = data[k] > 0 ? data[k + 1] : column + data[k + 1];
    line += data[k];
    const kind = legend[data[k + 3]];
    const wanted = KINDS[kind] ?? kind;
    compared += 1;
    const different = found[line].slice(column, column + data[k + 2]).find((c) => c !== wanted);
    if (different && said++ < 3) {
      const word = lines[line].slice(column, column + data[k + 2]);
      console.log(`FAILED ${script}:${line + 1}:${column + 1}: \`${word}\` is ${wanted}, by the grammar ${different}`);
    }
    wrong += different ? 1 : 0;
  }
}
await server.ask("shutdown", null);
server.tell("exit", null);
console.log(`${scripts.length} scripts, ${compared} words coloured, ${wrong} of them otherwise than the interpreter reads them`);
process.exitCode = wrong > 0 || compared < 1000 ? 1 : 0;
