// Tangents as the package mikktspace computes them.
//
//     node tangents.mjs FOLDER MODEL...
//
// Writes each primitive that has a normal map as a model of its own without tangents, FOLDER/N.glb,
// and prints a list of {"file", "name", "tangents"}: four numbers for each corner of its triangles.
// The fourth number is negated, because the v axis of glTF points down.

import { Document, NodeIO, Primitive } from "@gltf-transform/core";
import { ALL_EXTENSIONS } from "@gltf-transform/extensions";
import { MeshoptDecoder } from "meshoptimizer";
import { generateTangents } from "mikktspace";
import { join } from "node:path";

const PIXEL = "iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAIAAACQd1PeAAAADElEQVR42mNoaPgPAAMEAYAkPHOBAAAAAElFTkSuQmCC";
const ATTRIBUTES = ["POSITION", "NORMAL", "TEXCOORD_0"];

const [folder, ...models] = process.argv.slice(2);
const io = new NodeIO().registerExtensions(ALL_EXTENSIONS).registerDependencies({ "meshopt.decoder": MeshoptDecoder });
const written = [];

/** The elements of an attribute for each corner of the triangles. */
function corners(primitive, name) {
  const attribute = primitive.getAttribute(name);
  const indices = primitive.getIndices();
  const count = indices ? indices.getCount() : attribute.getCount();
  const element = [];
  return new Float32Array(
    Array.from({ length: count }, (_, i) => [...attribute.getElement(indices ? indices.getScalar(i) : i, element)]).flat(),
  );
}

/** Writes a primitive as a model without tangents; returns its file. */
async function write(primitive) {
  const alone = new Document();
  const buffer = alone.createBuffer();
  const texture = alone.createTexture().setImage(Buffer.from(PIXEL, "base64")).setMimeType("image/png");
  const copy = alone.createPrimitive().setMaterial(alone.createMaterial().setNormalTexture(texture));
  for (const name of ATTRIBUTES) {
    const { array, type } = { array: primitive.getAttribute(name).getArray(), type: primitive.getAttribute(name).getType() };
    copy.setAttribute(name, alone.createAccessor().setArray(array.slice()).setType(type).setBuffer(buffer));
  }
  const indices = primitive.getIndices();
  if (indices) copy.setIndices(alone.createAccessor().setArray(indices.getArray().slice()).setType("SCALAR").setBuffer(buffer));
  alone.createScene().addChild(alone.createNode().setMesh(alone.createMesh().addPrimitive(copy)));
  const file = join(folder, `${written.length}.glb`);
  await io.write(file, alone);
  return file;
}

for (const model of models) {
  const document = await io.read(model);
  for (const mesh of document.getRoot().listMeshes()) {
    for (const primitive of mesh.listPrimitives()) {
      const isMapped = primitive.getMaterial()?.getNormalTexture() && primitive.getMode() === Primitive.Mode.TRIANGLES;
      if (!isMapped || !ATTRIBUTES.every((name) => primitive.getAttribute(name)?.getComponentType() === 5126)) continue;
      const tangents = generateTangents(...ATTRIBUTES.map((name) => corners(primitive, name)));
      const mirrored = [...tangents].map((value, i) => (i % 4 === 3 ? -value : value));
      written.push({ file: await write(primitive), name: `${model}: ${mesh.getName()}`, tangents: mirrored });
    }
  }
}
console.log(JSON.stringify(written));
