# Points that doubles turn and move: boxes, rays, meshes. u = 2^-53.
# proves: src/scene/world/bodies.c "below 64u" 64 >= 46
# proves: src/query/frame/frame.h "#define PIR_TURN_ERROR 0x1p-47" 64 >= 46
# proves: src/scene/query/scene_ray.c "#define SEEN_ERROR 0x1p-47" 64 >= 63
# proves: src/mesh/pair/mesh_frame.c "below 2^-46 of `size`" 128 >= 125
# proves: src/solid/space/rest.c "a turned direction is within 2^-47" 64 >= 54
# proves: src/dymsum/update/lag.c "#define SLACK_ERROR 0x1p-47" 64 >= 14
#
# A vertex or a translation is off by u, the matrix by 31u, 37u where it may be relative, and the product rounds by
# 5.3u (dot.g), a sum by u: `point`, over the lengths of both. A slack of such a point has a normal, off by 8u, a dot
# product and two sums. A product of two matrices rounds by 9.1u in Frobenius norm, nine entries by 3.02u each.
point = (1 + v) * (1 + dr) * (1 + rows) * (1 + s) - 1;
seen = (1 + point) * (1 + n) * (1 + last) * (1 + s) * (1 + s) - 1;
two = (1 + r) * (1 + r) * (1 + nine) - 1;
mesh = (1 + two) * (1 + rows) * (1 + v) * (1 + s) * (1 + point) - 1;
direction = (1 + r) * (1 + rows) * (1 + kept) - 1;
support = (1 + n) * (1 + last) * (1 + v) * (1 + s) - 1;
{ v in [0, 1b-53] /\ dr in [0, 37b-53] /\ r in [0, 31b-53] /\ rows in [0, 0x5.4p-53] /\ s in [0, 1b-53]
/\ n in [0, 8b-53] /\ last in [0, 0x3.02p-53] /\ nine in [0, 0x9.1p-53] /\ kept in [0, 16b-53]
-> point in [0, 46b-53] /\ seen in [0, 63b-53] /\ mesh in [0, 125b-53] /\ direction in [0, 54b-53]
/\ support in [0, 14b-53] }
