/* SPDX-License-Identifier: MIT */
/* A polytope of what a reader made of a file. */
#ifndef PIR_POLYTOPE_READ_MODEL_MAKE_H
#define PIR_POLYTOPE_READ_MODEL_MAKE_H

#include "polytope/surface/model.h"

/*
 * The hull of the points, made as `options` say, and what the facets are before it is taken. Where they require a
 * convex model, PIR_ERR_NOT_CLOSED or PIR_ERR_NOT_CONVEX when the facets bound no convex solid. `ret_surface` may be
 * NULL.
 */
pir_status pir_model_make(const struct pir_model *model, const pir_read_options *options, pir_surface *ret_surface,
                          pir_polytope **ret_polytope);

#endif
