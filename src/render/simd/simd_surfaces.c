/* Preparation of surfaces for simd_newton_body.h. */
#include "render/simd/simd_kernels.h"

#define WR_FORMULA_FLOAT
#include "surface/formula.h"
#include "surface/frame.h"
#include "surface/bezier.h"

/* Weights of four control points in a cubic's coefficients about the middle, t = u - 1/2, in eighths. */
static const double middle[4][4] = {
    { 1, 3, 3, 1 }, { -6, -6, 6, 6 }, { 12, -12, -12, 12 }, { -8, 24, -24, 8 }
};

static void fill_patch(const float *points, WrWideSheet *sheet)
{
    for (int axis = 0; axis < 3; axis++)
        for (int j = 0; j < 4; j++)
            for (int i = 0; i < 4; i++) {
                double sum = 0;
                for (int k = 0; k < 16; k++)
                    sum += middle[i][k % 4] * middle[j][k / 4] * (double)points[3 * k + axis];
                sheet->patch[axis][4 * j + i] = (float)(sum / 64);
            }
}

bool wr_wide_sheet(WrSurfaceKind kind, const WrShapef *shape, WrWideSheet *sheet)
{
    *sheet = (WrWideSheet){ .kind = kind };
    if (kind == WR_SURFACE_bezier) {
        fill_patch(shape->value, sheet);
        sheet->noise = bezier_noise_f(shape);
        return true;
    }
    if (kind != WR_SURFACE_torus) return false;
    sheet->ring = shape->value[0], sheet->tube = shape->value[1];
    /* A ring, whose normal is that of Pu x Pv. */
    return sheet->tube < 0.99f * sheet->ring && sheet->tube > 1e-3f * sheet->ring;
}
