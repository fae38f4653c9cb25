/* SPDX-License-Identifier: MIT */
/* The lead of the least facet: see lead.h. */
#include "pair/facet/lead.h"

pir_lead pir_lead_of(const pir_placement *placement, const pir_facet *facet, double others) {
    double slack = facet->h - pir_vec_dot(facet->n, placement->x);
    return (pir_lead){others, slack - placement->error * facet->err, facet->n};
}

bool pir_lead_lasts(const pir_lead *lead, const pir_placement *placement, const pir_same_facet *same, double moved) {
    // what a slack is off by at either placement is in `fallen`, what unit normals are off by in the last term of c
    double most = same->slack + placement->error * same->facet.err, fallen = moved + 4 * placement->error;
    if (!(lead->others - fallen > most))
        return false;
    double s = most * most, m = same->margin * same->margin, k = s > m ? (s - m) / (s + m) : 0;
    pir_vec3 turned = pir_vec_sub(same->facet.n, lead->n);
    double c = sqrt(pir_vec_dot(turned, turned)) * (1 + 0x1p-40) + 0x1p-35;
    return lead->slack > (most + fallen) * (k + c) * (1 + 0x1p-40);
}
