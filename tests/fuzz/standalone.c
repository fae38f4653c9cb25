/* SPDX-License-Identifier: MIT */
/* Runs a fuzz target without an engine: over each file named, and over each file of each directory named. */
#include <dirent.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "fuzz/input.h"

/* Runs the target on one file's bytes; 0 when it could not be read. */
static int run_file(const char *path) {
    FILE *file = fopen(path, "rb");
    if (!file) {
        perror(path);
        return 0;
    }
    uint8_t *data = NULL;
    size_t size = 0, got;
    do {
        uint8_t *larger = realloc(data, size + 65536);
        if (!larger) {
            free(data);
            fclose(file);
            return 0;
        }
        data = larger;
        got = fread(data + size, 1, 65536, file);
        size += got;
    } while (got > 0);
    int bad = ferror(file);
    fclose(file);
    // Exactly as many bytes as the target is told, so that reading past them is seen.
    uint8_t *exact = malloc(size ? size : 1);
    if (exact && !bad) {
        memcpy(exact, data, size);
        LLVMFuzzerTestOneInput(exact, size);
    }
    free(data);
    bad = bad || !exact;
    free(exact);
    return !bad;
}

/* Runs the target on all files of a directory; how many, or -1 when one could not be read. */
static int run_directory(DIR *directory, const char *path) {
    int count = 0;
    for (struct dirent *entry; (entry = readdir(directory)) != NULL;) {
        char file[4096];
        if (entry->d_name[0] == '.')
            continue;
        snprintf(file, sizeof file, "%s/%s", path, entry->d_name);
        if (!run_file(file))
            return -1;
        count++;
    }
    return count;
}

int main(int argc, char **argv) {
    int total = 0;
    for (int i = 1; i < argc; i++) {
        DIR *directory = opendir(argv[i]);
        int count = directory ? run_directory(directory, argv[i]) : run_file(argv[i]) ? 1 : -1;
        if (directory)
            closedir(directory);
        if (count < 0)
            return 1;
        total += count;
    }
    // A replay of nothing proves nothing.
    if (total == 0) {
        fprintf(stderr, "no inputs\n");
        return 1;
    }
    printf("%d inputs\n", total);
    return 0;
}
