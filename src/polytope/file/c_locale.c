/* SPDX-License-Identifier: MIT */
/* See c_locale.h. */
#include "polytope/file/c_locale.h"

bool pir_c_locale_enter(struct pir_c_locale *ret_locale) {
    ret_locale->own = newlocale(LC_ALL_MASK, "C", (locale_t)0);
    if (ret_locale->own == (locale_t)0)
        return false;
    ret_locale->previous = uselocale(ret_locale->own);
    return true;
}

void pir_c_locale_leave(struct pir_c_locale *locale) {
    uselocale(locale->previous);
    freelocale(locale->own);
}
