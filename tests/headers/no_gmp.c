/* SPDX-License-Identifier: MIT */
/* A user of pirouette.h does not meet GMP's names. */
#include <pirouette/pirouette.h>

#ifdef __GNU_MP_VERSION
#error "pirouette.h includes gmp.h"
#endif

int main(void) {
    return pir_version() == NULL;
}
