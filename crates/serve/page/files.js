// Files that the user drops or selects: a scene and the files that it refers to.

/** Maximum total size of the files, in bytes, unless the caller has another. */
const MOST = 1 << 30;

/** Endings of the names of files that can be opened, the most likely one first. */
const OPENED = [".json", ".gltf", ".glb", ".obj", ".ply", ".stl"];

/** All files of a drop, folders included, as { name, file }; names include the dropped folders. */
async function dropped(transfer) {
  const files = [];
  // The browser discards the items at the first await.
  const entries = [...transfer.items].filter(({ kind }) => kind === "file").map((item) => {
    const entry = item.webkitGetAsEntry?.();
    if (!entry) files.push(...chosen([item.getAsFile()]));
    return entry;
  });
  for (const entry of entries.filter(Boolean)) await walk(entry, files);
  return files;
}

async function walk(entry, files) {
  if (entry.isFile) {
    const file = await new Promise((done, failed) => entry.file(done, failed));
    files.push({ name: entry.fullPath.replace(/^\//, ""), file });
    return;
  }
  const reader = entry.createReader();
  for (;;) {
    const some = await new Promise((done, failed) => reader.readEntries(done, failed));
    if (some.length === 0) return;
    for (const child of some) await walk(child, files);
  }
}

/** Passes the files of each drop on the page to `take`, and marks the page while files hover over it. */
export function watchDrops(take) {
  let inside = 0;
  const mark = (by) => document.body.classList.toggle("dropping", (inside = Math.max(0, inside + by)) > 0);
  addEventListener("dragenter", () => mark(1));
  addEventListener("dragleave", () => mark(-1));
  addEventListener("dragover", (event) => event.preventDefault());
  addEventListener("drop", async (event) => {
    event.preventDefault();
    mark(-inside);
    take(await dropped(event.dataTransfer));
  });
}

export const chosen = (list) => [...list].map((file) => ({ name: file.webkitRelativePath || file.name, file }));

/**
 * Finds the scene, or else the model or mesh, in the fewest folders, and reads the bytes of all files, at most `most`.
 */
export async function scene(files, most = MOST) {
  const depth = ({ name }) => name.split("/").length;
  const ending = ({ name }) => OPENED.findIndex((ending) => name.toLowerCase().endsWith(ending));
  const scenes = files.filter((file) => ending(file) >= 0);
  scenes.sort((a, b) => ending(a) - ending(b) || depth(a) - depth(b));
  if (scenes.length === 0) throw new Error(`there is no scene among the files: its name ends in ${OPENED.join(", ")}`);
  const sum = files.reduce((bytes, { file }) => bytes + file.size, 0);
  const mebibytes = (bytes) => Math.round(bytes / 2 ** 20);
  if (sum > most) throw new Error(`the files have ${mebibytes(sum)} MiB; the page takes up to ${mebibytes(most)}`);
  const bytes = await Promise.all(files.map(({ file }) => file.arrayBuffer()));
  return { name: scenes[0].name, files: files.map(({ name }, i) => ({ name, bytes: bytes[i] })) };
}
