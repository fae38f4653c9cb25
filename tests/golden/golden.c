/* SPDX-License-Identifier: MIT */
/*
 * Runs the golden histories with each version of the kernels that this processor runs, and compares their hashes with
 * the kept ones. Without a file it prints them, for golden.txt. Exit status 1 where one differs.
 *
 *     golden [golden.txt]
 *
 * Hashes may change only when what the library answers is meant to change, down to the last bit of a number.
 */
#include <inttypes.h>
#include <stdio.h>
#include <string.h>

#include "golden/golden.h"

#define HISTORIES 200

static const struct kind {
    const char *name;
    uint64_t (*run)(uint64_t number);
    uint64_t count;
} kinds[] = {
    {"sum", golden_sum, 60},          {"query", golden_query, 30},   {"pair", golden_pair, 40},
    {"scene", golden_scene, 24},      {"slices", golden_slices, 16}, {"solid", golden_solid, 10},
    {"simplify", golden_simplify, 8}, {"file", golden_file, 12},
};

/* The hashes of all histories, in the order of `kinds`; how many there are. */
static unsigned run_all(uint64_t hashes[HISTORIES]) {
    unsigned count = 0;
    for (size_t k = 0; k < sizeof kinds / sizeof *kinds; k++)
        for (uint64_t i = 0; i < kinds[k].count && count < HISTORIES; i++)
            hashes[count++] = kinds[k].run(i);
    return count;
}

static void print(FILE *to, unsigned index, uint64_t hash) {
    size_t k = 0;
    uint64_t number = index;
    for (; number >= kinds[k].count; k++)
        number -= kinds[k].count;
    fprintf(to, "%s %" PRIu64 " %016" PRIx64 "\n", kinds[k].name, number, hash);
}

/* How many of the hashes are not those of the file, which are told. */
static unsigned compare(const char *path, const char *kernels, const uint64_t *hashes, unsigned count) {
    FILE *file = fopen(path, "r");
    if (!file) {
        fprintf(stderr, "golden: cannot read %s\n", path);
        return count;
    }
    unsigned wrong = 0;
    for (unsigned i = 0; i < count; i++) {
        uint64_t kept = 0;
        if (fscanf(file, "%*s %*u %16" SCNx64, &kept) == 1 && kept == hashes[i])
            continue;
        fprintf(stderr, "%s kernels, instead of %016" PRIx64 ": ", kernels, kept);
        print(stderr, i, hashes[i]);
        wrong++;
    }
    fclose(file);
    return wrong;
}

int main(int argc, char **argv) {
    uint64_t hashes[HISTORIES];
    unsigned wrong = 0;
    if (argc != 2) {
        unsigned count = run_all(hashes);
        for (unsigned i = 0; i < count; i++)
            print(stdout, i, hashes[i]);
        return 0;
    }
    for (unsigned v = 0; v < golden_kernels_count(); v++) {
        golden_kernels_take(v);
        unsigned count = run_all(hashes), differ = compare(argv[1], golden_kernels_name(v), hashes, count);
        printf("kernels %s: %u histories, %u differ\n", golden_kernels_name(v), count, differ);
        wrong += differ;
    }
    return wrong ? 1 : 0;
}
