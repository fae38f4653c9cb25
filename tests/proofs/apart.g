# Pairs apart without a frame: twice_by_norm, turned, views, PIR_PROOF_ERROR, missed. u = 2^-53.
# proves: src/pair/apart.c "what it leaves out is below 2^-58" 0.03125 >= 0.0159
# proves: src/pair/apart.c "a turn by a quaternion is off by 32u" 32 >= 30
# proves: src/pair/apart.c "so n is by 64u as P has it" 64 >= 61
# proves: src/pair/apart.c "by less than 128u of the lengths" 128 >= 68
# proves: src/query/proof/proof.h "#define PIR_PROOF_ERROR 0x1p-40" 8192 >= 140
# proves: src/query/decide/facet.h "#define PIR_SLOPE_BOUND 0x1p-46" 128 >= 26
#
# twice_by_norm: the norm n = |q|^2 (1 + e) has terms that are not negative, so e is that of the one of most roundings;
# a = n - 1 is exact (Sterbenz) and at most 2^-20. The number is (2 - 2 (a - a^2 (1 + r1)) (1 + r2)) (1 + r3), which
# is 2 (1 - a + a^2 + d) (1 + r3). As (1 - a + a^2) (1 + a) = 1 + a^3, it is 2 / |q|^2 but for `twice` of itself.
# `left` is what the series leaves out.
# turned: v + twice (w u x v + u x (u x v)). Over |v|, the first product is off by |w||u| `of_w`, the other by
# |u|^2 `of_u`, each cross product by `cross` of both lengths (cross.g).
# Lemma. 4 ws + 6 s^2 <= (3 + sqrt(13)) (w^2 + s^2), the greater eigenvalue of the form. So with of_w <= 4.01u and
# of_u <= 6.01u both together are off by 6.62u |q|^2 |v|, `both`, and times 2 / |q|^2 by twice that.
# Lemma. The sum of both is at most |u||q||v| long, and v changes by at most 2 |v|. Rounding each component by u moves
# a vector by u of its length.
# A view has the direction as it was kept, n, exactly. The world's is off by `turned`, the other body's by `other`. Its
# length is 1 but for `long`: brought to it (cross.g), and turned twice.
# Products: of the way, which is off by a difference s, of vertices, off by v (slack.g), and of middles, each rounded;
# `last` is a dot product's error (dot.g). At most four sums, then the length: `distance`, of all lengths together.
# A climb ends where slopes are at most 2^-49; they are of edges off by 6u: `rise`. The body rises by twice that times
# its slip, and four times PIR_SLOPE_BOUND is taken.
e = (1 + m) * (1 + m) * (1 + m) * (1 + m) - 1;
d = a * a * r1 * (1 + r2) + (a * a - a) * r2;
twice = (1 + a * a * a + d * (1 + a)) * (1 + r3) * (1 + e) - 1;
left = 2 * a * a * a / (1 + a);
of_w = (1 + cross) * (1 + s) - 1;
of_u = (1 + cross) * (1 + cross) - 1;
change = 2 * (both + s * (1 + both));
turned = (change + 2 * ((1 + t) * (1 + s) - 1) * (1 + change)) + s * (1 + 3 * t);
other = (1 + turn) * (1 + turn) - 1;
long = (1 + turn) * (1 + turn) * (1 + scaling) - 1;
way = (1 + turn) * (1 + s) * (1 + last) - 1;
vertex = (1 + two) * (1 + v) * (1 + last) - 1;
distance = (1 + most) * (1 + s) * (1 + s) * (1 + s) * (1 + s) * (1 + length) - 1;
rise = (1b-49 + ((1 + edge) * (1 + last) - 1)) * (1 + length);
{ |m| <= 1b-53 /\ |a| <= 1b-20 /\ |r1| <= 1b-53 /\ |r2| <= 1b-53 /\ |r3| <= 1b-53 /\ cross in [0, 3b-53]
/\ s in [0, 1b-53] /\ both in [0, 0x6.9fp-53] /\ t in [0, 0x5.1p-53] /\ turn in [0, 30b-53] /\ scaling in [0, 5b-53]
/\ last in [0, 0x3.02p-53] /\ v in [0, 3b-53] /\ two in [0, 61b-53] /\ most in [0, 68b-53] /\ length in [0, 66b-53]
/\ edge in [0, 6b-53]
-> |twice| <= 0x5.1p-53 /\ |left| <= 0x0.041p-53 /\ of_w in [0, 0x4.02p-53] /\ of_u in [0, 0x6.02p-53]
/\ turned in [0, 30b-53] /\ other in [0, 61b-53] /\ long in [0, 66b-53] /\ way in [0, 35b-53] /\ vertex in [0, 68b-53]
/\ distance in [0, 140b-53] /\ rise in [0, 26b-53] }
