/* SPDX-License-Identifier: MIT */
/* Which versions of pir_singles_place this build has. */
#ifndef PIR_QUERY_CONTACT_SINGLE_VERSIONS_H
#define PIR_QUERY_CONTACT_SINGLE_VERSIONS_H

#include "query/contact/single.h"

#if defined(__x86_64__) && defined(__GNUC__)
#define PIR_HAVE_X86_SINGLES 1
pir_singles_place pir_singles_place_avx2;
#endif

#endif
