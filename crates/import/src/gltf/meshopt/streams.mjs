// Writes the streams of the tests, by the reference encoder. In a folder with the npm package
// `meshoptimizer` (1.3.0): `node streams.mjs > streams.txt`.
//
// A line has mode, filter, count, stride, the FNV-1a hash (64 bits) of what the reference decoder
// makes of the stream, and the stream.
import { MeshoptEncoder as encoder } from 'meshoptimizer/encoder';
import { MeshoptDecoder as decoder } from 'meshoptimizer/decoder';

await encoder.ready;
await decoder.ready;

const hex = (bytes) => Buffer.from(bytes).toString('hex') || '-';
const counts = [0, 1, 2, 3, 15, 16, 17, 255, 256, 257];

function hash(bytes) {
  let state = 0xcbf29ce484222325n;
  for (const byte of bytes) state = ((state ^ BigInt(byte)) * 0x100000001b3n) & 0xffffffffffffffffn;
  return state.toString(16).padStart(16, '0');
}

// A hash of an integer (PCG: Jarzynski, Olano 2020).
function noise(value) {
  const state = Math.imul(value, 747796405) + 2891336453;
  const word = Math.imul((state >>> ((state >>> 28) + 4)) ^ state, 277803737);
  return ((word >>> 22) ^ word) >>> 0;
}

function line(mode, filter, count, stride, stream, original) {
  const decoded = new Uint8Array(count * stride);
  // The reference decoder refuses empty triangle lists that the reference encoder writes.
  if (count > 0) decoder.decodeGltfBuffer(decoded, count, stride, stream, mode, filter);
  // The triangle codec may rotate the vertices of a triangle.
  if (mode !== 'TRIANGLES' && filter === 'NONE' && hex(decoded) !== hex(original)) throw new Error('not the original');
  console.log(mode, filter, count, stride, hash(decoded), hex(stream));
}

// Four bytes of an element, of several kinds.
const kinds = [
  () => 0x04030201,
  (i, k) => noise(i * 256 + k),
  (i, k) => [0, 1, 2, 3].reduce((word, j) => word | (((i * (k + j) + (noise(i + k) & 3)) & 255) << (8 * j)), 0),
  (i, k) => ((i * 97 * (k + 1) + (noise(i) & 31)) & 0xffff) | ((i * 13 + k) << 16),
  (i, k) => new Uint32Array(new Float32Array([(i * (k + 4)) / 16]).buffer)[0],
  (i, k) => (noise(i + k) % 29 === 0 ? noise(i) : 0x07070707),
  (i, k) => ((noise(i + k) & 15) << 12) | 0x3f000000,
];

function attributes(count, stride, kind) {
  const words = new Uint32Array((count * stride) / 4);
  words.forEach((_, at) => {
    const [element, channel] = [Math.floor((4 * at) / stride), (4 * at) % stride];
    words[at] = kinds[kind](element, channel);
  });
  return new Uint8Array(words.buffer);
}

let turn = 0;
for (const version of [0, 1]) {
  for (const count of counts) {
    for (const stride of [4, 8, 12, 16, 20, 32, 64]) {
      if (count * stride > 4200) continue;
      turn += 1;
      const kind = count * stride > 1100 ? [0, 5, 6, 4][turn % 4] : turn % kinds.length;
      const bytes = attributes(count, stride, kind);
      const stream = encoder.encodeVertexBufferLevel(bytes, count, stride, version === 0 ? 2 : 3, version);
      line('ATTRIBUTES', 'NONE', count, stride, stream, bytes);
    }
  }
}
// Elements of 64 and of 256 bytes, in blocks of 128 and of 32.
for (const [count, stride] of [[257, 64], [33, 256]]) {
  const bytes = attributes(count, stride, 0);
  line('ATTRIBUTES', 'NONE', count, stride, encoder.encodeVertexBufferLevel(bytes, count, stride, 2, 1), bytes);
}

// What the filters read, with another precision per element.
const signed = (value, max) => (value % (2 * max + 1)) - max;
const filters = {
  OCTAHEDRAL: (i, bits) => {
    const max = 2 ** ((i % (bits - 1)) + 1) - 1;
    const x = signed(noise(3 * i), max);
    return [x, signed(noise(3 * i + 1), max), max, noise(i)];
  },
  QUATERNION: (i) => {
    const max = 2 ** ((i % 13) + 3) - 1;
    return [0, 1, 2].map((k) => signed(noise(3 * i + k), max)).concat([(max & ~3) | (i & 3)]);
  },
  COLOR: (i, bits) => {
    const max = 2 ** ((i % (bits - 1)) + 2) - 1;
    const y = max >> 1;
    const part = y >> 1;
    return [y, signed(noise(2 * i), part), signed(noise(2 * i + 1), part), ((max + 1) >> 1) | (noise(i) & (max >> 1))];
  },
};
for (const [filter, make] of Object.entries(filters)) {
  for (const stride of filter === 'QUATERNION' ? [8] : [4, 8]) {
    for (const count of [1, 17, 100]) {
      const words = Array.from({ length: count }, (_, i) => make(i, 2 * stride)).flat();
      const array = stride === 4 ? Uint8Array.from(words) : Uint16Array.from(words);
      const bytes = new Uint8Array(array.buffer);
      line('ATTRIBUTES', filter, count, stride, encoder.encodeVertexBufferLevel(bytes, count, stride, 2, 1));
    }
  }
}
for (const [count, stride] of [[201, 4], [67, 12]]) {
  const make = (_, i) => (((i % 201) - 100) << 24) | (noise(i) & 0xffffff);
  const bytes = new Uint8Array(Int32Array.from({ length: (count * stride) / 4 }, make).buffer);
  line('ATTRIBUTES', 'EXPONENTIAL', count, stride, encoder.encodeVertexBufferLevel(bytes, count, stride, 2, 0));
}

const grid = (side) =>
  Array.from({ length: side * side }, (_, i) => i + Math.floor(i / side)).flatMap((a) => {
    const b = a + side + 1;
    return [a, a + 1, b, a + 1, b + 1, b];
  });
const random = (count, limit) => Array.from({ length: count }, (_, i) => noise(i) % limit);
const lists = [
  [],
  [0, 1, 2],
  [7, 3, 7, 1, 1, 2],
  grid(4),
  grid(4).concat(grid(4)),
  Array.from({ length: 30 }, (_, i) => [0, i + 1, i + 2]).flat(),
  random(258, 40),
  random(96, 60000),
];
for (const list of lists) {
  for (const stride of [2, 4]) {
    const array = stride === 2 ? Uint16Array.from(list) : Uint32Array.from(list);
    const bytes = new Uint8Array(array.buffer);
    line('TRIANGLES', 'NONE', list.length, stride, encoder.encodeIndexBuffer(bytes, list.length, stride), bytes);
  }
}
for (const count of counts) {
  const stride = count % 2 === 0 ? 2 : 4;
  const list = count > 100 ? Array.from({ length: count }, (_, i) => i + (i % 2) * 500) : random(count, 60000);
  const array = stride === 2 ? Uint16Array.from(list) : Uint32Array.from(list);
  const bytes = new Uint8Array(array.buffer);
  line('INDICES', 'NONE', count, stride, encoder.encodeIndexSequence(bytes, count, stride), bytes);
}
