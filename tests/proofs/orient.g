# Orientations of points in hulls: PIR_ORIENT_BOUND. u = 2^-53. Every step is rounded as doubles are.
# proves: src/polytope/hull/orient.h "#define PIR_ORIENT_BOUND 0x1p-43" 1024 >= 600
#
# Coordinates a, b, c, p of `near` points are at most 1 in magnitude and off by 1.05u from A, B, C, P.
@d = float<ieee_64, ne>;
ux d= bx - ax; uy d= by - ay; uz d= bz - az;
vx d= cx - ax; vy d= cy - ay; vz d= cz - az;
nx d= uy * vz - uz * vy; ny d= uz * vx - ux * vz; nz d= ux * vy - uy * vx;
px d= qx - ax; py d= qy - ay; pz d= qz - az;
h d= nx * px + ny * py + nz * pz;
Ux = Bx - Ax; Uy = By - Ay; Uz = Bz - Az;
Vx = Cx - Ax; Vy = Cy - Ay; Vz = Cz - Az;
Nx = Uy * Vz - Uz * Vy; Ny = Uz * Vx - Ux * Vz; Nz = Ux * Vy - Uy * Vx;
H = Nx * (Qx - Ax) + Ny * (Qy - Ay) + Nz * (Qz - Az);
{ |ax| <= 1 /\ |ay| <= 1 /\ |az| <= 1 /\ |bx| <= 1 /\ |by| <= 1 /\ |bz| <= 1 /\ |cx| <= 1 /\ |cy| <= 1 /\ |cz| <= 1
/\ |qx| <= 1 /\ |qy| <= 1 /\ |qz| <= 1
/\ |ax - Ax| <= 0x1.1p-53 /\ |ay - Ay| <= 0x1.1p-53 /\ |az - Az| <= 0x1.1p-53
/\ |bx - Bx| <= 0x1.1p-53 /\ |by - By| <= 0x1.1p-53 /\ |bz - Bz| <= 0x1.1p-53
/\ |cx - Cx| <= 0x1.1p-53 /\ |cy - Cy| <= 0x1.1p-53 /\ |cz - Cz| <= 0x1.1p-53
/\ |qx - Qx| <= 0x1.1p-53 /\ |qy - Qy| <= 0x1.1p-53 /\ |qz - Qz| <= 0x1.1p-53
-> |h - H| <= 600b-53 }
