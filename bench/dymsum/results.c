/* SPDX-License-Identifier: MIT */
/* The machine is named by its processor's model and number of cores, as the operating system tells them. */
#include "results.h"

#include <ctype.h>
#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

/* The processor's model, or "unknown processor". */
static void find_processor(char *name, size_t size) {
    snprintf(name, size, "unknown processor");
    FILE *file = fopen("/proc/cpuinfo", "r");
    char line[256];
    while (file && fgets(line, sizeof line, file)) {
        char *colon = strchr(line, ':');
        if (!colon || strncmp(line, "model name", 10) != 0)
            continue;
        colon += 1 + strspn(colon + 1, " \t");
        colon[strcspn(colon, "\n")] = '\0';
        snprintf(name, size, "%s", colon);
        break;
    }
    if (file)
        fclose(file);
}

/* Lower case letters and digits, everything else one hyphen. */
static void name_folder(const char *machine, char *name, size_t size) {
    size_t n = 0;
    for (const char *c = machine; *c && n + 1 < size; c++) {
        if (isalnum((unsigned char)*c))
            name[n++] = (char)tolower((unsigned char)*c);
        else if (n > 0 && name[n - 1] != '-')
            name[n++] = '-';
    }
    name[n] = '\0';
}

static void make_folder(const char *path) {
    if (mkdir(path, 0777) == 0 || errno == EEXIST)
        return;
    fprintf(stderr, "bench: cannot make the folder %s: %s\n", path, strerror(errno));
    exit(1);
}

struct results results_new(const char *root) {
    struct results results;
    char processor[96], name[128];
    if (root[0] == '-') {
        fprintf(stderr, "bench: %s: the folder of the results is wanted, and no options\n", root);
        exit(2);
    }
    find_processor(processor, sizeof processor);
    snprintf(results.machine, sizeof results.machine, "%s, %ld cores", processor, sysconf(_SC_NPROCESSORS_ONLN));
    name_folder(results.machine, name, sizeof name);
    snprintf(results.folder, sizeof results.folder, "%s/%s", root, name);
    make_folder(root);
    make_folder(results.folder);
    return results;
}

FILE *results_open(const struct results *results, const char *name) {
    char path[1280];
    snprintf(path, sizeof path, "%s/%s", results->folder, name);
    FILE *file = fopen(path, "w");
    if (!file) {
        fprintf(stderr, "bench: cannot write %s: %s\n", path, strerror(errno));
        exit(1);
    }
    return file;
}

void results_close(FILE *file, const char *name) {
    if (ferror(file) | fclose(file)) {
        fprintf(stderr, "bench: cannot write %s\n", name);
        exit(1);
    }
}

uint32_t results_count(uint32_t usual) {
    return usual > 3 && getenv("PIR_BENCH_SMOKE") ? 3 : usual;
}
