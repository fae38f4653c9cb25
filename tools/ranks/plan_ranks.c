/* SPDX-License-Identifier: MIT */
/* pirouette plan by any motion as ranks of MPI, which share the boxes of rotations. */
#include <string.h>

#include "../cmd.h"
#include "../message.h"
#include "../plan_motions.h"
#include "ranks.h"

SUBCOMMAND(plan_by_ranks) {
    struct ranks ranks;
    if (!ranks_begin(&ranks))
        return EXIT_BAD_INPUT;
    const pir_plan_ranks shared = {ranks.number, ranks.count, &ranks, ranks_exchange};
    const int result = plan_by(args, &shared);
    // others may wait for one that has failed by itself
    if (result != EXIT_DONE)
        ranks_stop(&ranks);
    ranks_end(&ranks);
    return result;
}
