"""Movies, which the program renders."""

import os
import signal
import subprocess
import sys
import time
import unittest
import unittest.mock

import juggler as jg
from juggler._movie import frames_of
from support import ROOT, SMALL, Folder, environment, needs_numpy, numpy, python


class Movies(Folder):
    def test_movies_are_rendered(self):
        jg.render_movie("juggler", self.folder / "a.webp", frames=range(2), **SMALL)
        self.assertEqual((self.folder / "a.webp").read_bytes()[8:12], b"WEBP")
        with self.assertRaises(jg.SettingsError):
            jg.render_movie("juggler", self.folder / "a.docx", frames=range(2), **SMALL)
        jg.render_movie("juggler", os.fsencode(self.folder / "b.webp"), frames=[0, 1], **SMALL)
        self.assertEqual((self.folder / "a.webp").read_bytes(), (self.folder / "b.webp").read_bytes())
        words = [sys.executable, "-m", "juggler", "render", "juggler", "--frames=0..2", "--size=32x18"]
        words += ["--samples=2", "-q", "-o", str(self.folder / "c.webp")]
        subprocess.run(words, env=environment(), check=True)
        self.assertEqual((self.folder / "a.webp").read_bytes(), (self.folder / "c.webp").read_bytes())
        jg.render_movie("juggler", self.folder / "all.webp", size=(8, 8), samples=1)
        self.assertGreater((self.folder / "all.webp").stat().st_size, 1000)

    @needs_numpy
    def test_movies_have_frames_without_gaps(self):
        for frames in (range(3), [0, 1, 2], (0, 1, 2), numpy.arange(3), numpy.arange(3.0), range(3, 4, 5)):
            self.assertEqual(frames_of(frames), range(3) if len(frames) == 3 else range(3, 4))
        for frames in (3, (0, 3), [], "ab", range(-2, 2), range(0, 6, 2), range(2, 0, -1), [0.5], [[0, 1]]):
            with self.assertRaisesRegex(jg.SettingsError, "consecutive frames from 0 on") as caught:
                jg.render_movie("juggler", self.folder / "a.gif", frames=frames, **SMALL)
            self.assertEqual(caught.exception.setting, "frames")
        with self.assertRaisesRegex(jg.SettingsError, r"`b.mkv` is no movie: .* \.mp4 \.webp \.apng \.gif$"):
            jg.render_movie("juggler", "b.mkv", frames=range(2), **SMALL)
        with self.assertRaisesRegex(jg.FileError, "no folder"):
            jg.render_movie("juggler", self.folder / "no" / "a.gif", frames=range(2), **SMALL)
        with self.assertWarnsRegex(jg.SceneWarning, "beyond the end"):
            jg.render_movie("chess-opening", self.folder / "a.gif", frames=range(1000, 1001), **SMALL)

    def test_movies_show_their_progress_and_print_nothing(self):
        seen = []
        jg.render_movie("juggler", self.folder / "a.gif", range(3), progress=seen.append, **SMALL)
        shares = [progress.share for progress in seen]
        self.assertEqual((shares[0], shares[-1]), (0, 1))
        self.assertEqual(shares, sorted(shares))
        self.assertEqual((seen[-1].stage, seen[-1].samples), ("rendering", 3 * 32 * 18 * 2))
        with self.assertRaisesRegex(LookupError, "stop"):
            stop = unittest.mock.Mock(side_effect=LookupError("stop"))
            jg.render_movie("juggler", self.folder / "b.gif", range(3), progress=stop, **SMALL)
        done = python(
            "import juggler, sys; juggler.render_movie('juggler', sys.argv[1], range(2), size=(16, 9), samples=1)",
            str(self.folder / "c.gif"),
        )
        self.assertEqual((done.returncode, done.stdout, done.stderr), (0, "", ""))

    def test_the_clip_decides_how_many_frames_a_movie_has(self):
        words = []
        with unittest.mock.patch("juggler._movie._run", lambda all, *_: words.extend(all) or 0):
            jg.render_movie(ROOT / "scenes/models/robot.glb", self.folder / "a.gif", animation="Idle")
        self.assertIn("--frames=..", words)

    def test_ctrl_c_ends_a_movie(self):
        code = "import juggler, signal, sys; signal.signal(signal.SIGINT, signal.default_int_handler)\n"
        code += "juggler.render_movie('juggler', sys.argv[1], samples=100000, size=(160, 90),"
        code += " progress=lambda p: print(p.share, flush=True))"
        words = [sys.executable, "-c", code, str(self.folder / "a.gif")]
        pipe = subprocess.PIPE
        with subprocess.Popen(words, env=environment(), stdout=pipe, stderr=pipe, text=True) as process:
            process.stdout.readline()
            start = time.monotonic()
            process.send_signal(signal.SIGINT)
            _, errors = process.communicate(timeout=60)
        self.assertIn("KeyboardInterrupt", errors)
        self.assertLess(time.monotonic() - start, 10)


if __name__ == "__main__":
    unittest.main()
