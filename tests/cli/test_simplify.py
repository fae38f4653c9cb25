#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""pirouette simplify."""
from command_test import CommandTest, main


class Simplify(CommandTest):
    def test_bodies_are_inside_and_around(self):
        inner, outer = self.path / "inner.off", self.path / "outer.off"
        told = self.data("simplify", "shape:geodesic?level=4", "--vertices", 30, "-o", inner, "--outer", outer)
        volumes = [self.data("info", model)["volume"] for model in (inner, "shape:geodesic?level=4", outer)]
        self.assertTrue(volumes[0] < volumes[1] < volumes[2])
        for which, path in (("inner", inner), ("outer", outer)):
            self.assertEqual(told[which]["vertices"], self.data("info", path)["vertices"])
            self.assertLessEqual(told[which]["vertices"], 30)
            self.assertTrue(0 < told[which]["error"] < 1)
        self.assertIn("30 vertices", self.good("simplify", "shape:geodesic?level=4", "--vertices", 30))

    def test_an_error_is_met(self):
        told = self.data("simplify", "shape:geodesic?level=4", "--error", 0.05)
        self.assertTrue(told["inner"]["error"] <= 0.05 and told["outer"]["error"] <= 0.05)
        self.assertLess(told["inner"]["vertices"], told["vertices"])
        exact = self.data("simplify", "shape:cube", "--error", 1e-30)
        self.assertEqual([exact[k]["error"] for k in ("inner", "outer")], [0, 0])

    def test_bad_arguments(self):
        self.bad("simplify", "shape:cube", says="--vertices N or --error E")
        self.bad("simplify", "shape:cube", "--vertices", 3, says="--vertices")
        self.bad("simplify", "shape:cube", "--error", -1, says="--error")
        self.bad("simplify", "shape:cube", "--vertices", 4, "-o", "-", "--outer", "-", says="standard output")
        self.bad("simplify", "shape:cube", "--vertices", 4, "-o", "x.txt", says="does not end in")


if __name__ == "__main__":
    main()
