/* SPDX-License-Identifier: MIT */
/* See launched.h: launchers tell it by variables of their own. */
#include "launched.h"

#include <stddef.h>
#include <stdlib.h>

bool launched_by_mpi(void) {
    static const char *const marks[] = {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE", "PMI_RANK", "PMIX_RANK"};
    for (size_t i = 0; i < sizeof marks / sizeof *marks; i++)
        if (getenv(marks[i]))
            return true;
    return false;
}
