/* SPDX-License-Identifier: MIT */
/*
 * Processes that make one file together, ranks of MPI. Of slices rank 0 deals the units and makes some as well; each
 * rank appends to a part of its own. Without a launcher such as mpirun there is one rank; in a build without MPI a
 * launcher that starts several is refused.
 *
 * A rank that fails is told to rank 0, and others make its unit. A rank that is killed ends the whole job, as MPI has
 * it; what all ranks had appended is then still there for a run with --resume.
 */
#ifndef TOOLS_RANKS_RANKS_H
#define TOOLS_RANKS_RANKS_H

#include <stdbool.h>

#include <pirouette/cspace.h>

#include "dealer.h"

struct ranks_shared;

struct ranks {
    uint32_t number, count;      /* of this rank; of all */
    struct ranks_shared *shared; /* NULL for one rank */
};

/* Joins the others where a launcher has started several. False after a complaint, in a build without MPI too. */
bool ranks_begin(struct ranks *ranks);

/* Waits until the others have ended as well. */
void ranks_end(struct ranks *ranks);

/* Whether `good` is true on all ranks; all call it. */
bool ranks_agree(const struct ranks *ranks, bool good);

/* Gives all ranks the bytes of each: `exchange` of pir_plan_ranks, of which a struct ranks is the context. */
bool ranks_exchange(void *context, const void *own, size_t size, void **ret_all, size_t *ret_size);

/* Ends all ranks at once, where there are others: they may wait for this one. */
void ranks_stop(const struct ranks *ranks);

/* The next unit for this rank: `claim` of a job's options, where there are several ranks. */
uint64_t ranks_next(const struct ranks *ranks);

/* The units of the job that all ranks have made, as far as rank 0 knows; on another rank 0. */
uint64_t ranks_done(const struct ranks *ranks);

/*
 * pir_cspace_job_run on all ranks, until all units are made. `pairs`: of pieces. Rank 0 may assemble the file after it
 * succeeded there.
 */
pir_status ranks_run(struct ranks *ranks, pir_cspace_job *job, uint64_t pairs, pir_report *report);

#endif
