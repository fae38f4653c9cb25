# Bodies that are apart still: angles of chords, BESIDE_UNIT, PIR_PROOF_ERROR. u = 2^-53.
# proves: src/exact/rotation.h "off by 5u, relatively; 1 + 2^-48 on the result holds that" 5 >= 5
# proves: src/exact/rotation.h "off by 5u, relatively; 1 + 2^-48 on the result holds that" 32 >= 23
# proves: src/query/proof/proof.c "each moves by less than 2^-20" 1 >= 0.502 of 2^-20
# proves: src/query/proof/proof.h "#define PIR_PROOF_ERROR 0x1p-40" 8192 >= 91
#
# A chord: differences d, squares m, sums s of terms that are not negative, the root, and what quaternions are beside
# their unit ones added.
# An angle is 4 (y + 0.2215 y^3), y half a chord: the term of most roundings has those of three chords, of the constant,
# three products, a sum and the product with 1 + 2^-48.
# A norm that is computed as 1 within 2^-20 is so within 5u more; brought to length 1 a quaternion moves by `beside`.
# Along n, which is off by `along` (47u where Q's matrix turns it, 66u in length, apart.g), a body has gone by a product
# with a difference s; `last` is a dot product's error (dot.g). Six sums are off by u of `way` each.
chord = (1 + d) * sqrt((1 + m) * (1 + s) * (1 + s) * (1 + s)) * (1 + r) * (1 + w) - 1;
angle = (1 + c) * (1 + c) * (1 + c) * (1 + s) * (1 + s) * (1 + s) * (1 + s) * (1 + s) * (1 + s) * (1 + s) - 1;
beside = sqrt(1 + n) - 1;
gone = (1 + along) * (1 + d) * (1 + last) * (1 + s) * (1 + s) * (1 + s) * (1 + s) * (1 + s) * (1 + s) - 1;
{ |d| <= 1b-53 /\ |m| <= 1b-53 /\ |s| <= 1b-53 /\ |r| <= 1b-53 /\ |w| <= 1b-53 /\ |c| <= 5b-53
/\ |n| <= 0x1.00001p-20 /\ along in [0, 80b-53] /\ last in [0, 0x3.02p-53]
-> |chord| <= 0x5.01p-53 /\ |angle| <= 23b-53 /\ |beside| <= 0x0.808p-20 /\ |gone| <= 91b-53 }
