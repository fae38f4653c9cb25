/* SPDX-License-Identifier: MIT */
/* Which versions of pir_same_facet_prove and pir_follow_foot this build has. */
#ifndef PIR_QUERY_LAST_SAME_FACET_VERSIONS_H
#define PIR_QUERY_LAST_SAME_FACET_VERSIONS_H

#include "query/last/follow_foot.h"

#if defined(__x86_64__) && defined(__GNUC__)
#define PIR_HAVE_X86_SAME 1
pir_same_prover pir_same_facet_prove_avx2;
pir_foot_follower pir_follow_foot_avx2;
#endif

#endif
