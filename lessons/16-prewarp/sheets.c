#include "sheets.h"

/* Far away in the direction of the eye: where c points away from it, that is -k1 for an eye in front. */
static double at_infinity(double k, bool behind) {
    return k == 0.0 ? 0.0 : (k > 0.0) == behind ? INFINITY : -INFINITY;
}

Vec2 sheets_epipole(const PrewarpFactors *factors) {
    if (factors->k3 == 0.0)
        return v2(at_infinity(factors->k1, factors->behind), at_infinity(factors->k2, factors->behind));
    return v2(factors->k1 / factors->k3, factors->k2 / factors->k3);
}

/* The runs before and after the epipole, both toward it; the item that it lies in ends the second. */
static void runs_toward(double epipole, int count, Run runs[2]) {
    int own = (int)floor(clamp(epipole, -1.0, count));
    runs[0] = own > 0 ? (Run){0, own, 1} : (Run){0, 0, 1};
    runs[1] = own < 0 ? (Run){count - 1, -1, -1} : (Run){count - 1, own - 1, -1};
}

Sheets sheets_toward(Vec2 epipole, int columns, int rows) {
    Sheets sheets;
    runs_toward(epipole.x, columns, sheets.columns);
    runs_toward(epipole.y, rows, sheets.rows);
    return sheets;
}

Sheets sheets_plain(int columns, int rows) {
    return (Sheets){.rows = {{0, rows, 1}, {0, 0, 1}}, .columns = {{0, columns, 1}, {0, 0, 1}}};
}
