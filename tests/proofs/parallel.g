# Edges that are nearly parallel: PARALLEL_BOUND; angles between normals. u = 2^-53.
# proves: src/dymsum/mesh/edge_pair.c "#define PARALLEL_BOUND 0x1p-45" 256 >= 120
#
# A component of d x e, with d off by 8u and e, turned, by 51u (sign.g), has two products and a difference. Its product
# with a unit normal, turned as well, is a triple product.
part = (1 + a) * (1 + b) * (1 + m) * (1 + s) - 1;
along = (1 + a) * (1 + b) * (1 + b) * (1 + triple) - 1;
{ a in [0, 8b-53] /\ b in [0, 51b-53] /\ m in [0, 1b-53] /\ s in [0, 1b-53] /\ triple in [0, 8b-53]
-> part in [0, 62b-53] /\ along in [0, 120b-53] }
