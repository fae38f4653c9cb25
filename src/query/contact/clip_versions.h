/* SPDX-License-Identifier: MIT */
/* Which versions of pir_clip_place this build has. */
#ifndef PIR_QUERY_CONTACT_CLIP_VERSIONS_H
#define PIR_QUERY_CONTACT_CLIP_VERSIONS_H

#include "query/contact/clip.h"

#if defined(__x86_64__) && defined(__GNUC__)
#define PIR_HAVE_X86_CLIP 1
pir_clip_place pir_clip_place_avx2;
#endif

#endif
