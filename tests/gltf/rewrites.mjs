// Writes one model in other encodings, by gltf-transform.
//
//     node rewrites.mjs MODEL FOLDER
//
// The encodings in `plain` hold the same numbers as the model; those in `lossy` hold nearly the
// same. `decoded` maps encodings to files of what the decoders of this script, draco3dgltf and
// meshoptimizer, make of them. Each name is the path of a file below FOLDER. Prints all as JSON.

import { execFileSync } from "node:child_process";
import { mkdirSync, writeFileSync } from "node:fs";
import { dirname, join } from "node:path";
import { Format, NodeIO, VertexLayout } from "@gltf-transform/core";
import { ALL_EXTENSIONS } from "@gltf-transform/extensions";
import { draco, meshopt, quantize, sparse, textureCompress } from "@gltf-transform/functions";
import draco3d from "draco3dgltf";
import { ktx2 } from "ktx2-encoder/gltf-transform";
import { MeshoptDecoder, MeshoptEncoder } from "meshoptimizer";
import sharp from "sharp";

const [model, folder] = process.argv.slice(2);
await Promise.all([MeshoptDecoder.ready, MeshoptEncoder.ready]);
const io = new NodeIO().registerExtensions(ALL_EXTENSIONS).registerDependencies({
  "draco3d.decoder": await draco3d.createDecoderModule(),
  "draco3d.encoder": await draco3d.createEncoderModule(),
  "meshopt.decoder": MeshoptDecoder,
  "meshopt.encoder": MeshoptEncoder,
});

// Indices of another size, where all of them fit. A file without indices keeps none.
const indices = (Type) => (document) => {
  for (const accessor of document.getRoot().listAccessors()) {
    const isIndex = document.getRoot().listMeshes().some((mesh) =>
      mesh.listPrimitives().some((primitive) => primitive.getIndices() === accessor));
    const array = accessor.getArray();
    const largest = 2 ** (8 * Type.BYTES_PER_ELEMENT) - 1;
    if (isIndex && array.every((index) => index < largest)) accessor.setArray(Type.from(array));
  }
};

// One buffer that embeds its bytes, and images that embed theirs.
const embedded = async (document, path) => {
  const { json, resources } = await io.writeJSON(document, { format: Format.GLTF });
  for (const item of [...(json.buffers ?? []), ...(json.images ?? [])]) {
    if (!item.uri || !resources[item.uri]) continue;
    const type = item.mimeType ?? "application/octet-stream";
    item.uri = `data:${type};base64,${Buffer.from(resources[item.uri]).toString("base64")}`;
  }
  writeFileSync(path, JSON.stringify(json));
};

const imageDecoder = async (bytes) => {
  const { data, info } = await sharp(bytes).ensureAlpha().raw().toBuffer({ resolveWithObject: true });
  return { data: new Uint8Array(data), width: info.width, height: info.height };
};

const separate = (document) => io.setVertexLayout(VertexLayout.SEPARATE) && document;
const plain = {
  "binary.glb": [],
  "files/model.gltf": [],
  "embedded.gltf": [],
  "separate.glb": [separate],
  "sparse.glb": [sparse({ ratio: 1 })],
  "indices8.glb": [indices(Uint8Array)],
  "indices16.glb": [indices(Uint16Array)],
  "indices32.glb": [indices(Uint32Array)],
};
const lossy = {
  "draco-edgebreaker.glb": [draco({ method: "edgebreaker" })],
  "draco-sequential.glb": [draco({ method: "sequential" })],
  "meshopt-medium.glb": [meshopt({ encoder: MeshoptEncoder, level: "medium" })],
  "meshopt-high.glb": [meshopt({ encoder: MeshoptEncoder, level: "high" })],
  "quantized.glb": [quantize()],
};
const pictures = {
  "webp.glb": [textureCompress({ encoder: sharp, targetFormat: "webp", lossless: true })],
  "uastc.glb": [ktx2({ isUASTC: true, generateMipmap: false, imageDecoder })],
  "etc1s.glb": [ktx2({ isUASTC: false, qualityLevel: 255, generateMipmap: false, imageDecoder })],
};
const COMPRESSED = ["KHR_draco_mesh_compression", "EXT_meshopt_compression", "KHR_meshopt_compression"];

// Encoders join buffers, which .glb files need.
const oneBuffer = (document) => {
  const [first, ...others] = document.getRoot().listBuffers();
  document.getRoot().listAccessors().forEach((accessor) => accessor.setBuffer(first));
  others.forEach((buffer) => buffer.dispose());
};

const hasPictures = (await io.read(model)).getRoot().listTextures().length > 0;
if (hasPictures) Object.assign(lossy, pictures);
for (const [name, steps] of [...Object.entries(plain), ...Object.entries(lossy)]) {
  const document = await io.read(model);
  document.setLogger({ debug() {}, info() {}, warn() {}, error: console.error });
  io.setVertexLayout(VertexLayout.INTERLEAVED);
  oneBuffer(document);
  for (const step of steps) await step(document);
  const path = join(folder, name);
  mkdirSync(dirname(path), { recursive: true });
  if (name === "embedded.gltf") await embedded(document, path);
  else await io.write(path, document);
}
const gltfpack = new URL("node_modules/.bin/gltfpack", import.meta.url).pathname;
execFileSync(gltfpack, ["-i", model, "-o", join(folder, "gltfpack.glb"), "-cc", "-mi"]);
lossy["gltfpack.glb"] = [];

const decoded = {};
for (const name of Object.keys(lossy)) {
  const document = await io.read(join(folder, name));
  const used = document.getRoot().listExtensionsUsed().filter((one) => COMPRESSED.includes(one.extensionName));
  if (used.length === 0) continue;
  used.forEach((one) => one.dispose());
  decoded[name] = `decoded-${name}`;
  await io.write(join(folder, decoded[name]), document);
}
console.log(JSON.stringify({ plain: Object.keys(plain), lossy: Object.keys(lossy), decoded }));
