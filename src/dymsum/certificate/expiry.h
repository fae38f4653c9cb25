/* SPDX-License-Identifier: MIT */
/*
 * How long a certificate holds, from the signs that prove it.
 *
 * The value s of a sign, by unit vectors, is the sine of an angle. R has to turn by at least |s| before the sign
 * changes. That, less the filter's bound, is the margin. In an axial epoch the derivative s′ is known as well, and s
 * + s′t ± t²/2 bounds s after a turn by t (epoch.h).
 */
#ifndef PIR_DYMSUM_CERTIFICATE_EXPIRY_H
#define PIR_DYMSUM_CERTIFICATE_EXPIRY_H

#include <math.h>

#include "dymsum/certificate/epoch.h"
#include "exact/sign.h"

typedef struct pir_expiry {
    double margin;        /* the angle that R may turn by, about any axes */
    double ahead, behind; /* in an axial epoch: the phases until which it holds, from now: ahead ≥ 0 ≥ behind */
} pir_expiry;

/* An expiry that no sign has limited yet. */
static inline pir_expiry pir_expiry_never(void) {
    return (pir_expiry){HUGE_VAL, HUGE_VAL, -HUGE_VAL};
}

/* Predictions subtract the slack for the drift, and 2^-10 of that for the rounding in these functions. */
#define PIR_EXPIRY_SLACK (PIR_DRIFT_SLACK * (1 + 0x1p-10))

/*
 * Limits the expiry by a sign of value s and derivative `rate`. Where less than the slack is left, the certificate
 * expires at once by the phase. In that case the root is not used: its argument may be negative.
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
