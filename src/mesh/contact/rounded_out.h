/* SPDX-License-Identifier: MIT */
/* A place near P's where P, grown by its radius, meets no triangle. */
#ifndef PIR_MESH_CONTACT_ROUNDED_OUT_H
#define PIR_MESH_CONTACT_ROUNDED_OUT_H

#include "mesh/contact/way_out.h"

/*
 * Goes on from *out, where P without its radius meets nothing or is as it was, until its distance from all triangles is
 * the radius. Triangles are looked at elsewhere afterwards, and more may be gathered.
 */
pir_status pir_contact_find_rounded_way_out(pir_contact_job *job, pir_way_out *out);

#endif
