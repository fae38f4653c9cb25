# Facets in cells by floats: PIR_FLOAT_BOUND, PIR_FLOAT_SLACK. u = 2^-24.
# proves: src/dymsum/kernels/facet_checks.h "#define PIR_FLOAT_BOUND 0x1p-20f" 16 >= 12.125 of 2^-24
# proves: src/dymsum/kernels/facet_checks.h "#define PIR_FLOAT_SLACK 0x1p-18f" 64 >= 53 of 2^-24
#
# Entries are off by u of themselves, sqrt(3) u in norm, as a rotation has a Frobenius norm of sqrt(3); n and d by u; all
# else as in dot.g, with floats. Doubles' own errors are below 2^-40. A prediction over t <= 1 has the error of the value
# and t times that of the rate; its arithmetic takes 12u, drift 16u.
term = (1 + m) * (1 + a) * (1 + b) - 1;
last = |term|;
rows = sqrt(3) * last;
dr = sqrt(3) * 1b-24 + 1b-47;
turned = (1 + dr) * (1 + n) - 1 + rows * (1 + dr) * (1 + n);
value = (1 + turned) * (1 + k) * (1 + last) - 1;
predicted = value + value * t + own + drift;
{ |m| <= 1b-24 /\ |a| <= 1b-24 /\ |b| <= 1b-24 /\ n in [0, 0x1.0001p-24] /\ k in [0, 0x1.0001p-24] /\ t in [0, 1]
/\ own in [0, 12b-24] /\ drift in [0, 16b-24]
-> value in [0, 0xc.2p-24] /\ predicted in [0, 53b-24] }
