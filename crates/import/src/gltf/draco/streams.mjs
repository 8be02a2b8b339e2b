// Writes the streams of the tests, by the reference encoder. In a folder with the npm package
// `draco3dgltf` (1.5.7): `node streams.mjs > streams.txt`.
//
// A line has the stream, the number of vertices, the FNV-1a hash (64 bits) of the indices as the
// reference decoder returns them, and the attributes: name, identifier, component type, number of
// components and hash of the values.
import draco from 'draco3dgltf';

const encoders = await draco.createEncoderModule({});
const decoders = await draco.createDecoderModule({});

function hash(bytes) {
  let state = 0xcbf29ce484222325n;
  for (const byte of bytes) state = ((state ^ BigInt(byte)) * 0x100000001b3n) & 0xffffffffffffffffn;
  return state.toString(16).padStart(16, '0');
}

const types = {
  I8: [Int8Array, 'DT_INT8', 'AddInt8Attribute'],
  U8: [Uint8Array, 'DT_UINT8', 'AddUInt8Attribute'],
  I16: [Int16Array, 'DT_INT16', 'AddInt16Attribute'],
  U16: [Uint16Array, 'DT_UINT16', 'AddUInt16Attribute'],
  U32: [Uint32Array, 'DT_UINT32', 'AddUInt32Attribute'],
  F32: [Float32Array, 'DT_FLOAT32', 'AddFloatAttribute'],
};

function encode(grid, sequential, speed) {
  const [encoder, builder, mesh] = [new encoders.Encoder(), new encoders.MeshBuilder(), new encoders.Mesh()];
  builder.AddFacesToMesh(mesh, grid.indices.length / 3, Uint32Array.from(grid.indices));
  for (const attribute of grid.attributes) {
    const [array, , add] = types[attribute.component];
    const values = array.from(attribute.values);
    const kind = encoders[attribute.kind];
    attribute.id = builder[add](mesh, kind, values.length / attribute.size, attribute.size, values);
    if (attribute.bits) encoder.SetAttributeQuantization(kind, attribute.bits);
  }
  encoder.SetSpeedOptions(speed, speed);
  encoder.SetEncodingMethod(sequential ? encoders.MESH_SEQUENTIAL_ENCODING : encoders.MESH_EDGEBREAKER_ENCODING);
  const bytes = new encoders.DracoInt8Array();
  const length = encoder.EncodeMeshToDracoBuffer(mesh, bytes);
  return Uint8Array.from({ length }, (_, i) => bytes.GetValue(i));
}

function decode(stream, attributes) {
  const [decoder, mesh] = [new decoders.Decoder(), new decoders.Mesh()];
  const status = decoder.DecodeArrayToMesh(stream, stream.length, mesh);
  if (!status.ok()) throw new Error(status.error_msg());
  const read = (size, get) => {
    const pointer = decoders._malloc(size);
    get(pointer);
    const bytes = decoders.HEAPU8.slice(pointer, pointer + size);
    decoders._free(pointer);
    return hash(bytes);
  };
  const indices = 12 * mesh.num_faces();
  const words = [mesh.num_points(), read(indices, (at) => decoder.GetTrianglesUInt32Array(mesh, indices, at))];
  for (const attribute of attributes) {
    const stored = decoder.GetAttributeByUniqueId(mesh, attribute.id);
    const as = attribute.as ?? attribute.component;
    const size = mesh.num_points() * attribute.size * types[as][0].BYTES_PER_ELEMENT;
    const value = read(size, (at) =>
      decoder.GetAttributeDataArrayForAllPoints(mesh, stored, decoders[types[as][1]], size, at));
    words.push(attribute.name, attribute.id, as, attribute.size, value);
  }
  return words;
}

// A grid of side × side quadrilaterals. With `seam`, its left half has texture coordinates of its own.
function grid(side, seam) {
  const vertices = Array.from({ length: (side + 1) ** 2 }, (_, i) => [i % (side + 1), Math.floor(i / (side + 1))]);
  const cells = Array.from({ length: side * side }, (_, i) => i + Math.floor(i / side));
  let indices = cells.flatMap((a) => [a, a + 1, a + side + 1, a + 1, a + side + 2, a + side + 1]);
  let points = vertices.map(([x, y]) => ({ x, y, shift: 0 }));
  if (seam) {
    const half = points.length;
    points = points.concat(points.map((point) => ({ ...point, shift: 0.5 })));
    indices = indices.map((index, at) => (Math.floor(at / 6) % side < side / 2 ? index + half : index));
  }
  const list = (make) => points.flatMap(make);
  return {
    indices,
    attributes: [
      { name: 'POSITION', kind: 'POSITION', component: 'F32', size: 3, bits: 11,
        values: list(({ x, y }) => [x / side, y / side, ((x * 7 + y * 3) % 5) / 10]) },
      { name: 'NORMAL', kind: 'NORMAL', component: 'F32', size: 3, bits: 8,
        values: list(({ x, y }) => [x - y, y - 1, 2].map((value, _, all) => value / Math.hypot(...all))) },
      { name: 'TEXCOORD_0', kind: 'TEX_COORD', component: 'F32', size: 2, bits: 10,
        values: list(({ x, y, shift }) => [x / side / 2 + shift, y / side]) },
      { name: 'COLOR_0', kind: 'COLOR', component: 'U8', size: 4, values: list(({ x, y }) => [x * 9, y * 9, x + y, 255]) },
      { name: 'JOINTS_0', kind: 'GENERIC', component: 'U8', as: 'U16', size: 4,
        values: list(({ x, y }) => [x, y, x ^ y, 200]) },
      { name: '_ID', kind: 'GENERIC', component: 'I16', size: 1, values: list(({ x, y }) => [x - 100 * y]) },
    ],
  };
}

for (const [side, seam, sequential, speed] of [
  [1, false, false, 0], [4, false, false, 0], [4, false, false, 5], [4, false, false, 10], [4, false, true, 5],
  [6, true, false, 0], [6, true, false, 5], [6, true, true, 5], [30, false, false, 0], [256, false, false, 0],
]) {
  const { indices, attributes } = grid(side, seam);
  const used = side >= 30 ? attributes.slice(0, 1) : attributes;
  // Flat grids, whose triangles need hardly any bits.
  if (side >= 30) used[0].values = used[0].values.map((value, i) => (i % 3 === 2 ? 0 : value));
  const stream = encode({ indices, attributes: used }, sequential, speed);
  console.log(Buffer.from(stream).toString('hex'), ...decode(stream, used));
}
