// Colours of the picture in light and dark; those of the page itself are in style.css.

import { Color } from 'three';

const LIGHT = {
  ink: '#2b3440',
  curve: '#0f4fa8',
  point: '#1d2733',
  rim: '#ffffff',
  surface: '#a9bccf',
  mesh: '#c3ccd4',
  accent: '#f08a00',
  cut: '#d1242f',
  cap: '#c9b08a',
  loose: '#c4352b',
  triple: '#9a3fc4',
  other: '#2fa57a',
};
const DARK = {
  ink: '#0c1015',
  curve: '#7fb8ff',
  point: '#f0f4f8',
  rim: '#1b2027',
  surface: '#8ea4ba',
  mesh: '#9aa7b3',
  accent: '#ffa726',
  cut: '#ff6b6b',
  cap: '#8d7a58',
  loose: '#ff6b5e',
  triple: '#d28bf2',
  other: '#53d3a3',
};

export const theme = { dark: false, ...LIGHT };

export function setTheme(dark) {
  Object.assign(theme, dark ? DARK : LIGHT, { dark });
}

/** A colour as the screen shows it, three numbers from 0 to 1. */
export function rgb(text) {
  const n = parseInt(text.slice(1), 16);
  return [(n >> 16) / 255, ((n >> 8) & 255) / 255, (n & 255) / 255];
}

/** A colour uniform, kept as it stands on the screen. */
export const colorOf = (text) => new Color().setRGB(...rgb(text));

/** Colours that are told apart well, for patches, groups and deciders. */
const PALETTE = [
  '#5b8ff9',
  '#f6a04d',
  '#5ad8a6',
  '#e8684a',
  '#9270ca',
  '#f6d75a',
  '#6dc8ec',
  '#ff99c3',
  '#a3b861',
  '#b0766b',
  '#4e9ca8',
  '#c2b2e0',
  '#8a9aa9',
  '#d4a373',
  '#74a57f',
  '#e58fb1',
];
export const paletteColor = (i) => PALETTE[((i % PALETTE.length) + PALETTE.length) % PALETTE.length];

/** Red over yellow to green, for a share from 0 (bad) to 1 (good). */
export function goodness(share) {
  const stops = [
    [0.75, 0.15, 0.13],
    [0.94, 0.55, 0.15],
    [0.95, 0.85, 0.3],
    [0.5, 0.75, 0.35],
    [0.15, 0.58, 0.4],
  ];
  const x = Math.min(1, Math.max(0, share)) * (stops.length - 1);
  const i = Math.min(stops.length - 2, Math.floor(x));
  return stops[i].map((c, k) => c + (stops[i + 1][k] - c) * (x - i));
}
