/* SPDX-License-Identifier: MIT */
/* qhull of the pairwise sums, its reentrant library. */
#include "peers.h"

#include <stdio.h>
#include <stdlib.h>

#include <libqhull_r/libqhull_r.h>

struct peer_result peer_qhull(const pir_polytope *p, double matrix[3][3], const pir_polytope *q) {
    double start = peer_clock();
    uint32_t n = pir_polytope_vertex_count(p), m = pir_polytope_vertex_count(q);
    coordT *points = malloc((size_t)n * m * 3 * sizeof *points), *to = points;
    struct peer_result result = {0, 0, 0};
    if (!points)
        return result;
    for (uint32_t v = 0; v < n; v++) {
        pir_vec3 x = pir_polytope_vertex(p, v);
        double c[3];
        for (int i = 0; i < 3; i++)
            c[i] = matrix[i][0] * x.x + matrix[i][1] * x.y + matrix[i][2] * x.z;
        for (uint32_t w = 0; w < m; w++) {
            pir_vec3 y = pir_polytope_vertex(q, w);
            *to++ = c[0] + y.x;
            *to++ = c[1] + y.y;
            *to++ = c[2] + y.z;
        }
    }
    qhT qh;
    qh_zero(&qh, NULL);
    char command[] = "qhull";
    int failed = qh_new_qhull(&qh, 3, (int)(n * m), points, False, command, NULL, NULL);
    result.milliseconds = peer_clock() - start;
    if (!failed) {
        result.vertices = (uint32_t)qh.num_vertices;
        result.facets = (uint32_t)qh.num_facets;
    }
    qh_freeqhull(&qh, !qh_ALL);
    int left, total;
    qh_memfreeshort(&qh, &left, &total);
    free(points);
    return result;
}
