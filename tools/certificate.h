/* SPDX-License-Identifier: MIT */
/* --certificate: what proves an answer, to a file. */
#ifndef TOOLS_CERTIFICATE_H
#define TOOLS_CERTIFICATE_H

#include <pirouette/certificate.h>

#include "args.h"

/*
 * Whether --certificate, where it was given, names a file other than -o's, and none of `others` stands beside it: with
 * those options there is no certificate. The list ends with NULL. False after a complaint.
 */
bool certificate_check(const struct args *args, const char *const *others);

/* Writes the certificate to the file that --certificate names; frees it. False after a complaint. */
bool certificate_write(const struct args *args, pir_certificate *certificate);

#endif
