/* SPDX-License-Identifier: MIT */
/* See hand_over.h. */
#include "hand_over.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "command.h"
#include "message.h"

#define PROGRAM "pirouette-slices"

/* A longer path than this is refused. */
#define PATH_SIZE 4096

/* Where this program lies, without its name, to ret_folder: its length, or 0 where that is not told. */
static size_t own_folder(char ret_folder[PATH_SIZE]) {
    ssize_t length = readlink("/proc/self/exe", ret_folder, PATH_SIZE);
    if (length <= 0 || length >= PATH_SIZE)
        return 0;
    ret_folder[length] = '\0';
    char *slash = strrchr(ret_folder, '/');
    return slash ? (size_t)(slash - ret_folder) : 0;
}

int hand_over(char *const *argv) {
    // PIR_PROGRAMS_FOLDER leads from the folder of this program to that of the other, or begins with a slash
    static const char *const folders[] = {".", PIR_PROGRAMS_FOLDER};
    char own[PATH_SIZE], path[PATH_SIZE];
    const int length = (int)own_folder(own);
    int error = ENOENT;
    for (size_t i = 0; i < sizeof folders / sizeof *folders && error == ENOENT; i++) {
        const int base = folders[i][0] == '/' ? 0 : length;
        const int needed = snprintf(path, sizeof path, "%.*s%s%s/" PROGRAM, base, own, base ? "/" : "", folders[i]);
        if (needed >= PATH_SIZE || (base == 0 && folders[i][0] != '/'))
            continue;
        execv(path, argv);
        error = errno;
    }
    return complain("%s: " PROGRAM ", the program that has it, cannot be run: %s", argv[1], strerror(error));
}
