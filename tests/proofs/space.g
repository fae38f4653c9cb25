# Signs of solids: pir_space_side, and determinants of directions. u = 2^-53. Dot products are rounded as doubles are.
# proves: src/solid/space/space.h "f->err + p->err + 0x1p-48" 32 >= 10
# proves: src/solid/space/solid_signs.c "both below 2^-45" 256 >= 204
#
# n is a unit normal but for 2^-47, x no longer than sqrt(3), |d| as well. Partial sums are no longer than |n||x|. A
# determinant of three directions, each off by 2^-47, rounds by `triple` (cross.g).
@d = float<ieee_64, ne>;
s d= nx * x + ny * y + nz * z - h;
exact = nx * x + ny * y + nz * z - h;
det = (1 + e) * (1 + e) * (1 + e) * (1 + triple) - 1;
{ |nx| <= 0x1.0000001p0 /\ |ny| <= 0x1.0000001p0 /\ |nz| <= 0x1.0000001p0
/\ |x| <= 0x1.bb68p0 /\ |y| <= 0x1.bb68p0 /\ |z| <= 0x1.bb68p0 /\ |h| <= 0x1.bb68p0
/\ |nx * x + ny * y| <= 0x1.bb69p0 /\ |nx * x + ny * y + nz * z| <= 0x1.bb69p0
/\ e in [0, 1b-47] /\ triple in [0, 8b-53]
-> |s - exact| <= 10b-53 /\ det in [0, 204b-53] }
