/* SPDX-License-Identifier: MIT */
/* The cubes of bulge.h. */
#include "bulge.h"

#include <math.h>
#include <stdbool.h>

#include "spin.h"
#include "trial.h"

#define POINTS_MAX ((BULGE_LARGEST + 1) * (BULGE_LARGEST + 1) * (BULGE_LARGEST + 1))

/* From the grid point, of [−1, 1]³, to the bulging surface. */
static pir_vec3 bulge(pir_vec3 x, uint64_t *random) {
    x.x += 1e-3 * spin_random(random);
    x.y += 1e-3 * spin_random(random);
    x.z += 1e-3 * spin_random(random);
    double norm = fmax(fabs(x.x), fmax(fabs(x.y), fabs(x.z))) + 0.05 * sqrt(x.x * x.x + x.y * x.y + x.z * x.z);
    return (pir_vec3){5 * x.x / norm, 5 * x.y / norm, 5 * x.z / norm};
}

pir_polytope *bulge_cube(unsigned n, int flat) {
    pir_vec3 points[POINTS_MAX];
    size_t count = 0;
    uint64_t random = n;
    for (unsigned i = 0; i <= n; i++)
        for (unsigned j = 0; j <= n; j++)
            for (unsigned k = 0; k <= n; k++) {
                bool surface = i == 0 || j == 0 || k == 0 || i == n || j == n || k == n;
                pir_vec3 x = {2.0 * i / n - 1, 2.0 * j / n - 1, 2.0 * k / n - 1};
                if (surface)
                    points[count++] = flat ? (pir_vec3){5 * x.x, 5 * x.y, 5 * x.z} : bulge(x, &random);
            }
    pir_polytope *cube;
    trial_need(pir_polytope_create(points, count, NULL, &cube), "tessellated cube");
    return cube;
}
