// Upload of dropped files: the server keeps them in memory until this page opens them.

import { scene } from "./files.js";

/// Sends the files, of at most `most` bytes, to the server. Returns the number under which it keeps them.
export async function upload(files, most) {
  const { name, files: all } = await scene(files, most);
  const sizes = all.map(({ name, bytes }) => [name, bytes.byteLength]);
  const head = new TextEncoder().encode(JSON.stringify({ name, files: sizes }));
  const length = new DataView(new ArrayBuffer(4));
  length.setUint32(0, head.length, true);
  const body = new Blob([length, head, ...all.map(({ bytes }) => bytes)]);
  const answer = await fetch("/drop", { method: "POST", body });
  const text = (await answer.text()).trim();
  if (!answer.ok) throw new Error(text);
  return Number(text);
}
