// Writes the files of the tests, by the reference encoder. In a folder with the npm packages
// `ktx2-encoder` (0.6.0) and `three` (0.187), whose folder of libraries has the reference decoder:
// `node streams.mjs`, which writes `streams.txt`.
//
// A line has the file, the width and height of its picture, and the FNV-1a hash (64 bits) of the
// texels (RGBA) that the reference decoder returns for level 0.
import { encodeToKTX2 } from 'ktx2-encoder';
import { readFileSync, writeFileSync } from 'fs';
import { createRequire } from 'module';
import { resolve } from 'path';

const folder = resolve('node_modules/three/examples/jsm/libs/basis');
const names = ['module', 'exports', 'require', '__filename', '__dirname'];
const script = readFileSync(`${folder}/basis_transcoder.js`, 'utf8') + ';module.exports = BASIS';
const library = { exports: {} };
new Function(...names, script)(library, library.exports, createRequire(import.meta.url), folder, folder);
const basis = await library.exports({ wasmBinary: readFileSync(`${folder}/basis_transcoder.wasm`) });
basis.initializeBasis();
const RGBA32 = 13;

function hash(bytes) {
  let state = 0xcbf29ce484222325n;
  for (const byte of bytes) state = ((state ^ BigInt(byte)) * 0x100000001b3n) & 0xffffffffffffffffn;
  return state.toString(16).padStart(16, '0');
}

function channel(x, y, index, hasAlpha) {
  return [x * 16, y * 20, (x + y) & 4 ? 200 : 30, hasAlpha ? (x * 37 + y * 11) & 255 : 255][index];
}

function picture(width, height, hasAlpha) {
  const texel = (i) => [i % width, Math.floor(i / width)];
  const data = Uint8Array.from({ length: 4 * width * height }, (_, i) => channel(...texel(i >> 2), i & 3, hasAlpha));
  return { width, height, data };
}

function decode(file) {
  const opened = new basis.KTX2File(file);
  if (!opened.isValid() || !opened.startTranscoding()) throw new Error('not a file');
  const texels = new Uint8Array(opened.getImageTranscodedSizeInBytes(0, 0, 0, RGBA32));
  if (!opened.transcodeImage(texels, 0, 0, 0, RGBA32, 0, -1, -1)) throw new Error('no texels');
  return hash(texels);
}

const lines = [];
for (const [width, height, hasAlpha, isUASTC, needSupercompression, generateMipmap] of [
  [8, 8, false, false, false, false],
  [13, 7, true, false, false, false],
  [16, 16, false, false, false, true],
  [8, 8, false, true, false, false],
  [13, 7, true, true, false, false],
  [16, 16, true, true, true, true],
]) {
  const imageDecoder = async () => picture(width, height, hasAlpha);
  const options = { isUASTC, needSupercompression, generateMipmap, isKTX2File: true, imageDecoder };
  const file = new Uint8Array(await encodeToKTX2(new Uint8Array(4), options));
  lines.push([Buffer.from(file).toString('hex'), width, height, decode(file)].join(' '));
}
writeFileSync('streams.txt', `${lines.join('\n')}\n`);
