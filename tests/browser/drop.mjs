// Files that are dropped on a page, and models of the project as such files.

import { readFileSync } from "node:fs";
import { join } from "node:path";

const MODELS = join(import.meta.dirname, "../../scenes/models");

/// Drops files on a page; `files` maps names to texts or buffers.
export async function dropFiles(page, files) {
  const encoded = Object.entries(files).map(([name, content]) => [name, Buffer.from(content).toString("base64")]);
  await page.evaluate((files) => {
    const dataTransfer = new DataTransfer();
    for (const [name, text] of files) {
      const bytes = Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0));
      dataTransfer.items.add(new File([bytes], name));
    }
    window.dispatchEvent(new DragEvent("drop", { dataTransfer, bubbles: true, cancelable: true }));
  }, encoded);
}

/// Returns a model of the project as one .glb, and as a .gltf with its buffer and pictures.
export function model(name) {
  const glb = readFileSync(join(MODELS, `${name}.glb`));
  const length = glb.readUInt32LE(12);
  const document = JSON.parse(glb.subarray(20, 20 + length));
  const buffer = glb.subarray(28 + length);
  const parts = { [`${name}.bin`]: buffer };
  document.buffers[0].uri = `${name}.bin`;
  for (const [index, { bufferView, mimeType }] of (document.images ?? []).entries()) {
    const { byteOffset = 0, byteLength } = document.bufferViews[bufferView];
    const uri = `picture ${index}.${mimeType.split("/")[1]}`;
    parts[uri] = buffer.subarray(byteOffset, byteOffset + byteLength);
    document.images[index] = { uri: encodeURI(uri) };
  }
  return { glb: { [`${name}.glb`]: glb }, gltf: { [`${name}.gltf`]: JSON.stringify(document), ...parts } };
}
