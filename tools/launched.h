/* SPDX-License-Identifier: MIT */
/* Whether a launcher of MPI, such as mpirun, has started this process. */
#ifndef TOOLS_LAUNCHED_H
#define TOOLS_LAUNCHED_H

#include <stdbool.h>

bool launched_by_mpi(void);

#endif
