// Poses of one clip as three.js computes them.
//
//     node poses.mjs MODEL CLIP TIME...
//
// CLIP is the name of a clip, its number from 0, or `none` for the rest pose. Prints, for each time
// in seconds, bounds as JSON: [[min x, min y, min z], [max x, max y, max z]]. They are the bounds of
// all vertices of skins, and of the transformed bounding boxes of other meshes, as `juggler info`
// computes them. Rotations of keys are normalized, which three.js leaves to the file.

import { readFileSync } from "node:fs";
import { dirname, join } from "node:path";
import { AnimationMixer, Box3, Vector3 } from "three";
import { GLTFLoader } from "three/examples/jsm/loaders/GLTFLoader.js";

const [path, clip, ...times] = process.argv.slice(2);
// Images are not needed; the loader reads buffers as files and embedded data.
globalThis.self = globalThis;
globalThis.ProgressEvent = class {};
class NoImages {
  constructor() {
    this.name = "no images";
  }
  loadTexture() {
    return Promise.resolve(null);
  }
}
globalThis.fetch = async (request) => {
  const url = typeof request === "string" ? request : request.url;
  const bytes = url.startsWith("data:")
    ? Buffer.from(url.slice(url.indexOf(",") + 1), "base64")
    : readFileSync(url.replace(/^file:\/\//, ""));
  return new Response(bytes, { status: 200 });
};
globalThis.Request = class {
  constructor(url) {
    this.url = url;
  }
};

const file = readFileSync(path);
const content = file.buffer.slice(file.byteOffset, file.byteOffset + file.byteLength);
const loader = new GLTFLoader().register(() => new NoImages());
const gltf = await new Promise((resolve, reject) =>
  loader.parse(path.endsWith(".glb") ? content : file.toString(), join(dirname(path), "/"), resolve, reject));
const action = gltf.animations.find((animation) => animation.name === clip) ?? gltf.animations[Number(clip)];
for (const track of action?.tracks ?? []) {
  if (track.ValueTypeName !== "quaternion") continue;
  track.values = Float64Array.from(track.values);
  for (let i = 0; i < track.values.length; i += 4) {
    const length = Math.hypot(...track.values.slice(i, i + 4));
    for (let k = i; k < i + 4; k++) track.values[k] /= length;
  }
}
const mixer = new AnimationMixer(gltf.scene);
if (action) mixer.clipAction(action).play();
const vertex = new Vector3();
const bounds = times.map((time) => {
  // The last key of a clip counts, not the first one again.
  if (action) mixer.setTime(Math.min(Number(time), action.duration * (1 - 1e-12)));
  gltf.scene.updateMatrixWorld(true);
  const box = new Box3();
  gltf.scene.traverse((object) => {
    if (!object.isMesh) return;
    if (!object.isSkinnedMesh) {
      object.geometry.computeBoundingBox();
      box.union(object.geometry.boundingBox.clone().applyMatrix4(object.matrixWorld));
      return;
    }
    object.skeleton.update();
    for (let i = 0; i < object.geometry.attributes.position.count; i++) {
      box.expandByPoint(object.getVertexPosition(i, vertex).applyMatrix4(object.matrixWorld));
    }
  });
  return [box.min.toArray(), box.max.toArray()];
});
console.log(JSON.stringify({ duration: action?.duration ?? 0, bounds }));
