/* SPDX-License-Identifier: MIT */
/* What the benchmarks of sums share: a clock, medians, matrices. */
#include "peers.h"

#include <stdlib.h>
#include <string.h>
#include <time.h>

double peer_clock(void) {
    struct timespec now;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return (double)now.tv_sec * 1e3 + (double)now.tv_nsec * 1e-6;
}

static int compare(const void *a, const void *b) {
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

double peer_median(double *values, size_t count) {
    qsort(values, count, sizeof *values, compare);
    return values[count / 2];
}

void peer_matrix(pir_quat q, double m[3][3]) {
    double n = q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w;
    const double r[3][3] = {
        {1 - 2 * (q.y * q.y + q.z * q.z) / n, 2 * (q.x * q.y - q.w * q.z) / n, 2 * (q.x * q.z + q.w * q.y) / n},
        {2 * (q.x * q.y + q.w * q.z) / n, 1 - 2 * (q.x * q.x + q.z * q.z) / n, 2 * (q.y * q.z - q.w * q.x) / n},
        {2 * (q.x * q.z - q.w * q.y) / n, 2 * (q.y * q.z + q.w * q.x) / n, 1 - 2 * (q.x * q.x + q.y * q.y) / n}};
    memcpy(m, r, sizeof r);
}
