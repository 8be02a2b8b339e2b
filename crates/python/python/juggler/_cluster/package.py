"""Package of a scene: all that workers need to build its world, by the hashes of its contents."""

import hashlib
import pickle

from juggler import _native
from juggler._scene import native_scene


class Package:
    """Scene with its files. `blobs` has the contents by hash; they travel apart from the manifest, so
    that a machine fetches each once. Workers receive a package as `manifest` and `blobs`.
    """

    def __init__(self, scene, lenient=False):
        lenient = lenient or getattr(scene, "_lenient", False)
        native = native_scene(scene, lenient)
        name, text, files = _native.scene_package(native)
        self.native = native
        self.blobs = {digest: data for _, digest, data in files}
        if text is not None:
            text = self._blob(text.encode())
        assets = [(name, asset.digest, asset) for name, asset in native.assets()]
        self.blobs.update((digest, pickle.dumps(asset, protocol=5)) for _, digest, asset in assets)
        self.manifest = {
            "title": native.name,
            "name": name,
            "text": text,
            "files": [(path, digest) for path, digest, _ in files],
            "assets": [(name, digest) for name, digest, _ in assets],
            "lenient": bool(lenient),
        }

    def _blob(self, data):
        digest = hashlib.blake2b(data, digest_size=32).hexdigest()
        self.blobs[digest] = data
        return digest

    @property
    def size(self):
        """Number of bytes."""
        return sum(map(len, self.blobs.values()))

    def key(self, settings):
        """Name of the package with these settings."""
        content = pickle.dumps((self.manifest, sorted(settings.items(), key=lambda item: item[0])))
        return hashlib.blake2b(content, digest_size=16).hexdigest()


def unpack(manifest, blobs):
    """Returns the native scene of a package. `blobs` has the contents by hash."""
    text = manifest["text"]
    files = [(path, blobs[digest]) for path, digest in manifest["files"]]
    return _native.scene_from_package(
        manifest["title"],
        manifest["name"],
        None if text is None else blobs[text].decode(),
        files,
        manifest["lenient"],
        [(name, pickle.loads(blobs[digest])) for name, digest in manifest["assets"]],
    )
