/* SPDX-License-Identifier: MIT */
/* Fewer pieces, which contain the exact ones. */
#ifndef PIR_SOLID_PIECES_APPROXIMATE_H
#define PIR_SOLID_PIECES_APPROXIMATE_H

#include <pirouette/solid.h>

/*
 * Replaces *pieces by fewer, if there are to be fewer, of which none reaches out of the union of the old ones by more
 * than *ret_error: at most `most` of them (0 for no bound), and as few as joining them two by two makes where no error
 * is above `tolerance`. After a failure *pieces are the old ones.
 */
pir_status pir_pieces_approximate(pir_pieces **pieces, uint32_t most, double tolerance, double *ret_error);

#endif
