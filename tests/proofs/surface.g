# Inner surfaces of vertex pairs: pair/surface. u = 2^-53; `e` is a corner's error over the reach, at least 128u.
# proves: src/pair/surface/inner_surface.h "4 * error * reach * reach" 4 >= 4
# proves: src/pair/surface/inner_surface.h "10 * error * reach" 10 >= 10
#
# A det is a triple product of three corners, of length 1 over the reach, each off by e; it rounds by `triple` (cross.g).
# A normal is a product of two sides of length 2, each off by 2e; it rounds by 3u of 4. Both over e: `e` is bounded from
# below by what the rounding is, and from above so that its square does not count.
det = 3 + 3 * e + e * e + triple / e * ((1 + e) * (1 + e) * (1 + e));
normal = 8 + 4 * e + 4 * cross / e * ((1 + e) * (1 + e));
{ e in [128b-53, 1b-10] /\ triple in [0, 8b-53] /\ cross in [0, 3b-53]
-> det in [0, 4] /\ normal in [0, 10] }
