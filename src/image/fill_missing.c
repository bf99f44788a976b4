#include "image/fill_missing.h"

#include "base/error.h"
#include "base/memory.h"
#include "base/progress.h"

#include <math.h>

#define LEVELS 16
#define SWEEPS 24

typedef struct Level {
    int width, height;
    double *z;
} Level;

/* True if the loop should continue at value k: cancellation is checked only at intervals. */
static bool goes_on(size_t k)
{
    return k % 16384 != 0 || !wr_progress_stopped();
}

static bool is_hole(double z)
{
    return !(z == z);
}

/* Means of the valid ones among four texels. */
static void shrink(const Level *fine, Level *coarse)
{
    for (int j = 0; j < coarse->height && !wr_progress_stopped(); j++)
        for (int i = 0; i < coarse->width; i++) {
            double sum = 0.0;
            int count = 0;
            for (int b = 2 * j; b < 2 * j + 2 && b < fine->height; b++)
                for (int a = 2 * i; a < 2 * i + 2 && a < fine->width; a++) {
                    double z = fine->z[(size_t)b * (size_t)fine->width + (size_t)a];
                    if (is_hole(z)) continue;
                    sum += z;
                    count++;
                }
            coarse->z[(size_t)j * (size_t)coarse->width + (size_t)i] = count ? sum / count : NAN;
        }
}

static double mean_around(const Level *l, int i, int j)
{
    size_t w = (size_t)l->width, at = (size_t)j * w + (size_t)i;
    double sum = 0.0;
    int count = 0;
    if (i > 0) sum += l->z[at - 1], count++;
    if (i + 1 < l->width) sum += l->z[at + 1], count++;
    if (j > 0) sum += l->z[at - w], count++;
    if (j + 1 < l->height) sum += l->z[at + w], count++;
    return count ? sum / count : l->z[at];
}

/* Holes start with the height of the coarser texel, then become the mean of their neighbours in several
 * passes. */
static bool grow(Level *fine, const Level *coarse, int64_t *filled, WrError *err)
{
    size_t count = (size_t)fine->width * (size_t)fine->height, holes = 0, k = 0;
    for (size_t n = 0; n < count && goes_on(n); n++) holes += is_hole(fine->z[n]);
    *filled = (int64_t)holes;
    if (wr_progress_stopped()) return wr_fail(err, "cancelled");
    if (holes == 0) return true;
    size_t *hole = wr_try_alloc(holes, sizeof *hole, "holes of a picture", err);
    if (!hole) return false;
    for (int j = 0; j < fine->height; j++)
        for (int i = 0; i < fine->width; i++) {
            size_t at = (size_t)j * (size_t)fine->width + (size_t)i;
            if (!is_hole(fine->z[at])) continue;
            fine->z[at] = coarse->z[(size_t)(j / 2) * (size_t)coarse->width + (size_t)(i / 2)];
            hole[k++] = at;
        }
    for (int sweep = 0; sweep < SWEEPS; sweep++)
        for (k = 0; k < holes && goes_on(k); k++)
            fine->z[hole[k]] = mean_around(fine, (int)(hole[k] % (size_t)fine->width),
                                           (int)(hole[k] / (size_t)fine->width));
    wr_free(hole);
    return true;
}

int64_t wr_fill_missing(int width, int height, double *z, WrError *err)
{
    Level level[LEVELS] = { { width, height, z } };
    int64_t filled = 0, unused;
    size_t count = (size_t)width * (size_t)height, holes = 0;
    for (size_t n = 0; n < count && goes_on(n); n++) holes += is_hole(z[n]);
    if (wr_progress_stopped()) {
        wr_fail(err, "cancelled");
        return -2;
    }
    if (holes == 0) return 0;
    if (holes == count) return -1;
    int top = 0;
    bool good = true;
    while (good && (level[top].width > 1 || level[top].height > 1)) {
        const Level *fine = &level[top];
        Level *coarse = &level[top + 1];
        *coarse = (Level){ (fine->width + 1) / 2, (fine->height + 1) / 2, NULL };
        coarse->z = wr_try_alloc((size_t)coarse->width * (size_t)coarse->height, sizeof *coarse->z,
                                 "holes of a picture", err);
        good = coarse->z != NULL;
        if (good) shrink(fine, coarse);
        if (good && wr_progress_stopped()) good = wr_fail(err, "cancelled");
        top++;
    }
    for (int k = top - 1; good && k >= 0; k--)
        good = grow(&level[k], &level[k + 1], k ? &unused : &filled, err);
    for (int k = 1; k <= top; k++) wr_free(level[k].z);
    return good ? filled : -2;
}
