# Turns and determinants of triangles: pir_sign_turn, determinant_of. u = 2^-53, relative to the computed products.
# proves: src/mesh/signs/mesh_signs.c "0x1p-51 * (fabs(left) + fabs(right))" 4 >= 3.5
# proves: src/mesh/signs/mesh_signs.c "0x1p-50 * permanent" 8 >= 7.5
#
# A turn is left - right: a product m of two differences a and b, each rounded. A determinant's term is a product of
# three differences, with a difference s, two products m and m2, and a sum t before the last one. The last operation of
# all does not change the sign of what it rounds (Shewchuk, Discrete and Computational Geometry 18, 1997), but makes it
# smaller by u at most, c. The sum of magnitudes, and its product with the bound, round by three sums, two products: p.
# What underflows is below TINY.
turn = (1 / ((1 + a) * (1 + b) * (1 + m)) - 1) / ((1 - c) * (1 - p1));
det = ((1 + s) * (1 + m2) * (1 + t) / ((1 + a) * (1 + b) * (1 + c2) * (1 + m)) - 1) / ((1 - c) * (1 - p));
{ |a| <= 1b-53 /\ |b| <= 1b-53 /\ |c2| <= 1b-53 /\ |m| <= 1b-53 /\ |m2| <= 1b-53 /\ |s| <= 1b-53 /\ |t| <= 1b-53
/\ c in [0, 1b-53] /\ p1 in [0, 2b-53] /\ p in [0, 5b-53]
-> |turn| <= 0x3.8p-53 /\ |det| <= 0x7.8p-53 }
