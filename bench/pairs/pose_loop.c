/* SPDX-License-Identifier: MIT */
/*
 * A loop of a program's own over poses in a file: what bench/pairs/batch.py holds Python against.
 *
 *     pose_loop P.off Q.off POSES DISTANCES ROUNDS
 *
 * POSES holds seven doubles a pose, DISTANCES gets one each. Prints the nanoseconds of CPU time a pose
 * of each round.
 */
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

#include <pirouette/pirouette.h>

static void check(pir_status status) {
    if (status == PIR_OK)
        return;
    fprintf(stderr, "pose_loop: %s\n", pir_status_text(status));
    exit(2);
}

static double now(void) {
    struct timespec time;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
    return (double)time.tv_sec * 1e9 + (double)time.tv_nsec;
}

static double *read_poses(const char *path, size_t *ret_count) {
    FILE *file = fopen(path, "rb");
    if (!file || fseek(file, 0, SEEK_END) != 0)
        check(PIR_ERR_FILE);
    const long size = ftell(file);
    double *poses = malloc((size_t)size + 1);
    rewind(file);
    if (!poses || fread(poses, 1, (size_t)size, file) != (size_t)size)
        check(PIR_ERR_FILE);
    fclose(file);
    *ret_count = (size_t)size / (7 * sizeof *poses);
    return poses;
}

/* Asks what Python asks: distance, state, normal and points of each pose. */
static void ask(pir_pair *pair, pir_workspace *workspace, const double *poses, size_t count, pir_query_result *results,
                double *distances) {
    pir_pair_input input = pir_pair_input_default();
    for (size_t i = 0; i < count; i++) {
        const double *at = poses + 7 * i;
        input.pose_p = (pir_pose){{at[0], at[1], at[2], at[3]}, {at[4], at[5], at[6]}};
        check(pir_pair_signed_distance(pair, workspace, &input, &results[i % 4096]));
        distances[i] = results[i % 4096].distance;
    }
}

int main(int argc, char **argv) {
    static pir_query_result results[4096];
    pir_polytope *p, *q;
    pir_workspace *workspace;
    pir_pair *pair;
    size_t count;
    if (argc != 6) {
        fprintf(stderr, "usage: pose_loop P.off Q.off POSES DISTANCES ROUNDS\n");
        return 2;
    }
    check(pir_polytope_read(argv[1], NULL, NULL, NULL, &p));
    check(pir_polytope_read(argv[2], NULL, NULL, NULL, &q));
    check(pir_workspace_create(NULL, &workspace));
    check(pir_pair_create(p, q, NULL, &pair));
    double *poses = read_poses(argv[3], &count), *distances = malloc((count + 1) * sizeof *distances);
    if (!distances)
        check(PIR_ERR_MEMORY);
    for (int round = 0; round < atoi(argv[5]); round++) {
        const double from = now();
        ask(pair, workspace, poses, count, results, distances);
        printf("%.2f\n", (now() - from) / (double)count);
    }
    FILE *file = fopen(argv[4], "wb");
    if (!file || fwrite(distances, sizeof *distances, count, file) != count || fclose(file) != 0)
        check(PIR_ERR_FILE);
    free(poses);
    free(distances);
    pir_pair_destroy(pair);
    pir_workspace_destroy(workspace);
    pir_polytope_release(p);
    pir_polytope_release(q);
    return 0;
}
