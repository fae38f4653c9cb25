/* SPDX-License-Identifier: MIT */
/* The locale "C" for as long as numbers are read or written: they use '.' whatever the locale of the process is. */
#ifndef PIR_POLYTOPE_FILE_C_LOCALE_H
#define PIR_POLYTOPE_FILE_C_LOCALE_H

#include <locale.h>
#include <stdbool.h>

/* The thread's locale put aside for "C" between enter and leave; enter returns false when out of memory. */
struct pir_c_locale {
    locale_t own, previous;
};
bool pir_c_locale_enter(struct pir_c_locale *ret_locale);
void pir_c_locale_leave(struct pir_c_locale *locale);

#endif
