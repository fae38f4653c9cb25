/* SPDX-License-Identifier: MIT */
/* The order in which traversals go over the facets of a polytope: see facet_order.c. */
#ifndef PIR_POLYTOPE_FACET_ORDER_H
#define PIR_POLYTOPE_FACET_ORDER_H

#include "polytope/polytope.h"

/* Fills p->visit, once facets have neighbours. False when out of memory. */
bool pir_order_facets(pir_polytope *p);

#endif
