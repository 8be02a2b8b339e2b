"""Denoising of rendered images and of arrays."""

import unittest

import juggler as jg
from support import needs_numpy, numpy, small_scene

FEATURES = ["albedo", "normal", "depth"]


def rmse(image, reference):
    return float(numpy.sqrt(numpy.mean((numpy.asarray(image) - numpy.asarray(reference)) ** 2)))


@needs_numpy
class Denoising(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        # A sky alone: its soft shadows are noise, and no edges.
        scene = small_scene(lights=[], background={"solid": {"color": [1, 1, 1]}})
        settings = {"size": (64, 36), "integrator": "path"}
        cls.noisy = jg.render(scene, samples=8, aovs=FEATURES, **settings)
        cls.plain = jg.render(scene, samples=8, **settings)
        cls.clean = jg.render(scene, samples=8, denoise="own", **settings)
        cls.reference = jg.render(scene, samples=2048, **settings)

    def error(self, image):
        return rmse(image, self.reference)

    def test_an_image_is_denoised_after_its_render(self):
        denoised = self.noisy.denoised()
        self.assertLess(self.error(denoised), 0.6 * self.error(self.noisy))
        self.assertLess(self.error(self.plain.denoised()), self.error(self.plain))
        self.assertNotEqual(denoised.hash, self.noisy.hash)
        self.assertEqual(denoised.hash, self.noisy.denoised().hash)
        self.assertTrue(numpy.array_equal(denoised["albedo"], self.noisy["albedo"]))

    def test_an_image_without_noise_stays(self):
        self.assertEqual(self.clean.denoised().hash, self.clean.hash)

    def test_arrays_are_denoised_as_images(self):
        features = {name: self.noisy[name] for name in FEATURES}
        pixels = jg.denoise(self.noisy.color, **features)
        self.assertTrue(numpy.array_equal(pixels, self.noisy.denoised().color))
        wide = {name: values.astype(">f8") for name, values in features.items()}
        self.assertTrue(numpy.array_equal(jg.denoise(self.noisy.color.astype(float)[:, ::1], **wide), pixels))
        mirrored = jg.denoise(self.noisy.color[:, ::-1])
        self.assertLess(rmse(mirrored[:, ::-1], jg.denoise(self.noisy.color)), 0.05)

    def test_halves_are_sharper(self):
        scene = small_scene(lights=[], background={"solid": {"color": [1, 1, 1]}})
        halves = [
            jg.render(scene, samples=4, size=(64, 36), integrator="path", seed=seed, aovs=FEATURES)
            for seed in (1, 2)
        ]
        pixels = jg.denoise([image.color for image in halves], **{name: halves[0][name] for name in FEATURES})
        self.assertLess(self.error(pixels), 0.6 * self.error(self.noisy))

    def test_images_of_few_pixels(self):
        for shape in ((1, 1, 3), (1, 2, 3), (5, 1, 3), (2, 1, 1, 3)):
            pixels = jg.denoise(numpy.full(shape, 0.25))
            self.assertTrue(numpy.allclose(pixels, 0.25), shape)
        unknown = numpy.full((4, 4, 3), 0.5)
        unknown[1, 1] = numpy.nan
        self.assertTrue(numpy.isfinite(jg.denoise(unknown)).all())

    def test_mistakes(self):
        color = numpy.ones((4, 6, 3))
        for arguments in (
            {"color": color[..., :2]},
            {"color": color[0]},
            {"color": numpy.ones((3, 4, 6, 3))},
            {"color": numpy.ones((0, 6, 3))},
            {"color": "red"},
            {"color": color, "albedo": color[1:]},
            {"color": color, "depth": color},
            {"color": color, "denoiser": "owl"},
        ):
            with self.assertRaises(jg.SettingsError):
                jg.denoise(**arguments)


if __name__ == "__main__":
    unittest.main()
