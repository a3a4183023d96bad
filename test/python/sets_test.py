#!/usr/bin/env python3
"""Configuration sets: buckets as poses and targets, whose distances and volumes are those that the sets say.

usage: sets_test.py MANIFEST
"""

import os
import pathlib
import tempfile
import unittest

from common import arguments, main, numpy, sixdof

MANIFEST = arguments(1)
FILE = sixdof.catalogue(MANIFEST)["torus-1k"]["file"]


class Sets(unittest.TestCase):
    def setUp(self):
        self.set = sixdof.load_set(FILE)

    def test_catalogues(self):
        self.assertEqual(sixdof.catalogue(MANIFEST)["torus-1k"]["buckets"], ("distance/00", "distance/05", "volume/03"))
        own = sixdof.catalogue()
        self.assertIn("elephant", own)
        self.assertTrue(os.path.exists(own["torus-knot-10k"]["file"]))
        self.assertIn("volume/05", sixdof.load_set("torus-knot-10k").buckets)

    def test_buckets_are_poses_and_targets(self):
        self.assertEqual(list(self.set), ["distance/00", "distance/05", "volume/03"])
        self.assertIs(self.set.a, self.set.b)
        exact = sixdof.prepare("exact", self.set.a, self.set.b)
        for name in self.set:
            bucket = self.set[name]
            sample = bucket.poses(64)
            self.assertEqual(sample.poses.shape, (64, 4, 4))
            kind = "distance" if bucket.kind == "distance" else "volume"
            answers = exact.distance(sample.poses) if kind == "distance" else exact.respond(sample.poses)
            self.assertLessEqual(abs(getattr(answers, kind) - sample.target).max(), sample.tolerance)
            self.assertEqual(sample.target, bucket.target)
        self.assertEqual(self.set["distance/05"].nominal, 0.05 * self.set.a.diagonal)
        self.assertEqual(self.set["distance:05"], self.set["distance/05"])

    def test_all_configurations(self):
        bucket = self.set["volume/03"]
        everything = bucket.poses()
        self.assertEqual(len(everything.poses), bucket.reachable)
        self.assertEqual(len(set(everything.cells)), bucket.reachable)
        numpy.testing.assert_array_equal(bucket.poses(10).poses, everything.poses[:10])
        self.assertFalse(numpy.array_equal(bucket.poses(10, seed=2).cells, everything.cells[:10]))

    def test_poses_follow_from_the_grid(self):
        bucket = self.set["distance/05"]
        sample = bucket.poses(50)
        rotation, direction = numpy.divmod(sample.cells.astype(int), len(bucket.directions))
        self.assertEqual(bucket.translations.shape, (len(bucket.rotations), len(bucket.directions)))
        self.assertEqual(numpy.isfinite(bucket.translations).sum(), bucket.reachable)
        s = bucket.translations[rotation, direction]
        turned = sixdof.pose(bucket.rotations[rotation], numpy.zeros(3))[:, :3, :3]
        translation = self.set.a.center + s[:, None] * bucket.directions[direction] - turned @ self.set.b.center
        # Roundings of lengths of about 3.
        numpy.testing.assert_allclose(sample.poses, sixdof.pose(bucket.rotations[rotation], translation), atol=1e-14)

    def test_words_of_errors(self):
        with self.assertRaisesRegex(sixdof.BadArgument, "bucket: .*no distance/07; it has distance/00"):
            self.set["distance/07"]
        with self.assertRaisesRegex(sixdof.BadArgument, "name_or_file: no pair elefant; .*elephant"):
            sixdof.load_set("elefant")
        with self.assertRaisesRegex(sixdof.BadArgument, "count: -1"):
            self.set["distance/05"].poses(-1)
        with self.assertRaisesRegex(sixdof.BadFile, "none.h5: "):
            sixdof.load_set("./none.h5")
        with tempfile.TemporaryDirectory() as folder:
            part = pathlib.Path(folder) / "part.h5"
            part.write_bytes(pathlib.Path(FILE).read_bytes()[:5000])
            with self.assertRaisesRegex(sixdof.BadFile, "part.h5: "):
                sixdof.load_set(part)
        with self.assertRaisesRegex(sixdof.BadArgument, "torus-1k"):
            sixdof.load_set(FILE, a="torus-300")["distance/05"].poses(3)
        with self.assertRaisesRegex(sixdof.BadArgument, "a: .*tours"):
            sixdof.load_set(FILE, a="tours-1k").a


if __name__ == "__main__":
    main()
