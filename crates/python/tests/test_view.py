"""The viewer."""

import os
import unittest
import unittest.mock
import urllib.request

import juggler as jg
from support import small_scene


class Viewer(unittest.TestCase):
    def test_a_scene_is_served_until_it_is_closed(self):
        for scene in ("juggler", small_scene()):
            with jg.View(scene, {"size": (64, 36), "threads": 1}) as view:
                with urllib.request.urlopen(view.url) as page:
                    self.assertIn(b"<canvas", page.read())
                self.assertIn(view.url, repr(view))
                self.assertIn(f'<iframe src="{view.url}"', view._repr_html_())
            self.assertIn("closed", repr(view))
            with self.assertRaises(OSError):
                urllib.request.urlopen(view.url)

    def test_remote_notebooks_show_the_picture(self):
        settings = {"size": (16, 9), "samples": 1, "time": None}
        with (
            jg.View(small_scene(), {}) as view,
            unittest.mock.patch.dict(os.environ, {"SSH_CONNECTION": "1"}),
        ):
            view._settings = {name: value for name, value in settings.items() if value is not None}
            self.assertIn("data:image/png;base64", view._repr_html_())

    def test_mistakes(self):
        with self.assertRaisesRegex(jg.SettingsError, "no setting `samples`; it has size"):
            jg.View("juggler", {"samples": 4})
        with self.assertRaisesRegex(jg.SceneError, "jugler"):
            jg.View("jugler", {})
        with self.assertRaises(jg.SceneError):
            jg.View({"version": 1, "objects": [{"shape": "spere"}]}, {})


if __name__ == "__main__":
    unittest.main()
