/* SPDX-License-Identifier: MIT */
/*
 * How long a certificate may sleep, from the signs that prove it.
 *
 * A sign's value s, by unit vectors, is the sine of an angle at least |s| away from where it would change; less the
 * filter's bound that is the margin by the path. In an axial epoch s′ is known too, and s + s′t ± t²/2 bounds what
 * comes (clock.h).
 */
#ifndef PIR_DYMSUM_CERTIFICATE_EXPIRY_H
#define PIR_DYMSUM_CERTIFICATE_EXPIRY_H

#include <math.h>

#include "dymsum/certificate/epoch.h"
#include "exact/sign.h"

typedef struct pir_expiry {
    double margin;        /* by the path */
    double ahead, behind; /* by the phase, from now: ahead ≥ 0 ≥ behind */
} pir_expiry;

/* What no sign has shortened yet. */
static inline pir_expiry pir_expiry_never(void) {
    return (pir_expiry){HUGE_VAL, HUGE_VAL, -HUGE_VAL};
}

/* What foretelling gives away: the slack for the drift, and a hair of it for the rounding of all this. */
#define PIR_EXPIRY_SLACK (PIR_DRIFT_SLACK * (1 + 0x1p-10))

/*
 * Takes in a sign of value s that changes at `rate`. Where less than the slack is left, the certificate wakes at once
 * by the phase. The root of a negative number, which that case would take, is not looked at.
 */
static inline void pir_expiry_take_sign(pir_expiry *expiry, double s, double rate) {
    double margin = fabs(s) - PIR_SIGN_BOUND, sure = margin - PIR_EXPIRY_SLACK, rising = s < 0 ? rate : -rate;
    double root = sure > 0 ? sqrt(rising * rising + (sure + sure)) : 0;
    double ahead = sure > 0 ? root - rising : 0, behind = sure > 0 ? -rising - root : 0;
    margin = margin > 0 ? margin : 0;
    expiry->margin = margin < expiry->margin ? margin : expiry->margin;
    expiry->ahead = ahead < expiry->ahead ? ahead : expiry->ahead;
    expiry->behind = behind > expiry->behind ? behind : expiry->behind;
}

#endif
