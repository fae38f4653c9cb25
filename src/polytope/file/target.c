/* SPDX-License-Identifier: MIT */
/* Links followed one by one: POSIX has no call that does so for a file that is not there yet. */
#include "polytope/file/target.h"

#include <errno.h>
#include <string.h>
#include <unistd.h>

/* Links that are followed before they count as a circle. */
#define LINKS_MOST 40

bool pir_follow_links(const char *path, char ret_target[PIR_PATH_SIZE]) {
    errno = ENAMETOOLONG;
    size_t length = strlen(path);
    if (length >= PIR_PATH_SIZE)
        return false;
    memcpy(ret_target, path, length + 1);
    for (int links = 0; links < LINKS_MOST; links++) {
        char next[PIR_PATH_SIZE];
        ssize_t size = readlink(ret_target, next, sizeof next);
        if (size < 0)
            return true;
        // A relative link starts from the folder that it stands in.
        const char *slash = next[0] == '/' ? NULL : strrchr(ret_target, '/');
        size_t folder = slash ? (size_t)(slash + 1 - ret_target) : 0;
        errno = ENAMETOOLONG;
        if (folder + (size_t)size >= PIR_PATH_SIZE)
            return false;
        memcpy(ret_target + folder, next, (size_t)size);
        ret_target[folder + (size_t)size] = '\0';
    }
    errno = ELOOP;
    return false;
}
