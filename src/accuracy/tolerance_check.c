/* Check of a picture: some of its blocks, drawn at random, rendered with finer dials. */
#include "accuracy/tolerance_internal.h"
#include "base/error.h"
#include "base/memory.h"
#include "system/clock.h"

#include <math.h>
#include <string.h>

#define BLOCK WR_FRAME_BLOCK
#define BLOCK_FLOATS ((size_t)4 * BLOCK * BLOCK)

/* ---- frames ---- */

static void add_times(WrStageTimes *sum, const WrStageTimes *more)
{
    sum->prepare += more->prepare;
    sum->visibility += more->visibility;
    sum->geometry += more->geometry;
    sum->bump += more->bump;
    sum->shade += more->shade;
    sum->resolve += more->resolve;
    sum->total += more->total;
    sum->pyramid += more->pyramid;
}

bool wr_study_render(WrStudy *study, const WrDialSet *set, const unsigned char *only, bool fine,
                     WrError *err)
{
    WrScene *scene = wr_dial_set_apply(set, study->request->scene, fine);
    WrFrameRequest request = *study->request;
    request.scene = scene;
    request.dials = NULL;
    request.only = only;
    request.keep = false;
    request.hold = true; /* the copies of the table for the next setting */
    request.normals = NULL;
    request.map = NULL;
    const double start = wr_clock_seconds();
    const bool good = wr_renderer_frame(study->renderer, &request, study->frame, err);
    const double wall = wr_clock_seconds() - start;
    wr_scene_free(scene);
    if (!good) return false;
    if (!only) {
        study->covered = (double)study->frame->covered;
        study->seconds = wall - fmin(study->frame->times.prepare, wall);
    }
    study->frames++;
    study->shaded += study->frame->shaded;
    add_times(&study->times, &study->frame->times);
    wr_plan_add(&study->plan, study->frame->plan);
    return true;
}

/* ---- blocks ---- */

typedef struct Corner {
    int x, y, w, h; /* of a block, pixels */
} Corner;

static int blocks_across(const WrStudy *study)
{
    return (study->request->width + BLOCK - 1) / BLOCK;
}

static int64_t blocks_of(const WrStudy *study)
{
    return (int64_t)blocks_across(study) * ((study->request->height + BLOCK - 1) / BLOCK);
}

static Corner corner_of(const WrStudy *study, int64_t block)
{
    const WrFrameRequest *request = study->request;
    const int across = blocks_across(study);
    Corner at = { (int)(block % across) * BLOCK, (int)(block / across) * BLOCK, BLOCK, BLOCK };
    if (request->width - at.x < BLOCK) at.w = request->width - at.x;
    if (request->height - at.y < BLOCK) at.h = request->height - at.y;
    return at;
}

static float *pixel_of(const WrStudy *study, int x, int y)
{
    return study->frame->rgba + 4 * ((size_t)y * (size_t)study->request->width + (size_t)x);
}

void wr_check_copy(const WrCheck *check, float *out, bool back)
{
    for (int i = 0; i < check->count; i++, out += BLOCK_FLOATS) {
        const Corner at = corner_of(check->study, check->block[i]);
        const size_t row = (size_t)at.w * 4 * sizeof *out;
        if (!back) memset(out, 0, BLOCK_FLOATS * sizeof *out);
        for (int y = 0; y < at.h; y++) {
            float *pixels = pixel_of(check->study, at.x, at.y + y);
            float *own = out + (size_t)4 * BLOCK * (size_t)y;
            memcpy(back ? pixels : own, back ? own : pixels, row);
        }
    }
}

bool wr_check_render(WrCheck *check, const WrDialSet *set, float *out, WrError *err)
{
    if (!wr_study_render(check->study, set, check->only, out == check->fine, err)) return false;
    wr_check_copy(check, out, false);
    return true;
}

/* ---- drawing ---- */

#define SEED 0x9e3779b9u
#define EVEN 0.5 /* part of the mean variation that even blocks have at least */

static float difference(const float *a, const float *b)
{
    const float r = a[0] - b[0], g = a[1] - b[1], bl = a[2] - b[2], cover = a[3] - b[3];
    const float sum = r * r + g * g + bl * bl + cover * cover;
    return isfinite(sum) ? sum : 0;
}

/* Variation of each block: squared differences of neighbouring pixels in it and across its border; -1: neither it
   nor a pixel next to it has the object. */
static void measure_variation(const WrStudy *study, double *variation)
{
    const int wide = study->request->width, high = study->request->height;
    const int across = blocks_across(study);
    for (int64_t b = 0; b < blocks_of(study); b++) variation[b] = -1;
    for (int y = 0; y < high; y++)
        for (int x = 0; x < wide; x++) {
            const float *p = pixel_of(study, x, y);
            const int64_t here = (int64_t)(y / BLOCK) * across + x / BLOCK;
            const int64_t right = x + 1 < wide ? here + ((x + 1) % BLOCK == 0) : here;
            const int64_t down = y + 1 < high ? here + ((y + 1) % BLOCK == 0 ? across : 0) : here;
            const float *p_right = x + 1 < wide ? p + 4 : p;
            const float *p_down = y + 1 < high ? p + (size_t)4 * (size_t)wide : p;
            if (p[3] <= 0 && p_right[3] <= 0 && p_down[3] <= 0) continue;
            const double step_right = (double)difference(p, p_right);
            const double step_down = (double)difference(p, p_down);
            variation[here] = fmax(variation[here], 0) + step_right + step_down;
            if (right != here) variation[right] = fmax(variation[right], 0) + step_right;
            if (down != here) variation[down] = fmax(variation[down], 0) + step_down;
        }
}

/* Draws `wanted` blocks at equal steps of the sum of variation, from a random start. A block that is drawn with
   probability p stands for 1 / p blocks. */
static void draw(WrCheck *check, const double *variation, int64_t blocks, int wanted)
{
    double sum = 0, passed = 0;
    int64_t shown = 0;
    int drawn = 0;
    for (int64_t b = 0; b < blocks; b++) {
        if (variation[b] < 0) continue;
        shown++;
        sum += variation[b];
    }
    const double least = shown > 0 ? EVEN * sum / (double)shown + 1e-12 : 0;
    const double start = ((double)wr_mix32(SEED) + 0.5) / 4294967296.0;
    check->all = shown <= wanted;
    sum += least * (double)shown;
    for (int64_t b = 0; b < blocks; b++) {
        if (variation[b] < 0) continue;
        const double own = variation[b] + least, before = drawn;
        passed += own;
        while (passed * wanted >= (drawn + start) * sum && drawn < wanted) drawn++;
        if (!check->all && drawn == before) continue;
        check->weight[check->count] = check->all ? 1 : (drawn - before) * sum / (wanted * own);
        check->block[check->count++] = b;
        check->only[b] = 1;
    }
}

/* One block of this many is checked, within limits; for the largest error, as many as allowed. */
#define SHARE 40
#define BLOCKS_MIN 16
#define BLOCKS_MAX 64
#define BLOCKS_FOR_MAX 128

bool wr_check_begin(WrCheck *check, WrStudy *study, WrError *err)
{
    const int64_t blocks = blocks_of(study);
    double *variation = wr_alloc((size_t)blocks, sizeof *variation);
    int64_t shown = 0;
    measure_variation(study, variation);
    for (int64_t b = 0; b < blocks; b++) shown += variation[b] >= 0;
    const int64_t share = shown / SHARE;
    const int wanted = study->request->scene->tolerance.kind == WR_TOLERANCE_MAX ? BLOCKS_FOR_MAX
                       : share < BLOCKS_MIN                                      ? BLOCKS_MIN
                       : share > BLOCKS_MAX                                      ? BLOCKS_MAX
                                                                                 : (int)share;
    check->study = study;
    check->block = wr_alloc((size_t)wanted, sizeof *check->block);
    check->weight = wr_alloc((size_t)wanted, sizeof *check->weight);
    check->only = wr_alloc((size_t)blocks, 1);
    draw(check, variation, blocks, wanted);
    wr_free(variation);
    const size_t floats = (size_t)(check->count + 1) * BLOCK_FLOATS;
    check->picture = wr_try_alloc(3 * floats, sizeof(float), "blocks", err);
    if (!check->picture) return false;
    check->fine = check->picture + floats;
    check->other = check->fine + floats;
    return true;
}

void wr_check_fini(WrCheck *check)
{
    wr_free(check->block);
    wr_free(check->weight);
    wr_free(check->only);
    wr_free(check->picture);
    *check = (WrCheck){ 0 };
}

/* ---- errors ---- */

#define UNCERTAINTY 1.0 /* standard errors added to a mean */
#define UNSEEN_MAX 1.33 /* largest error of all pixels over that of the checked ones */

WrCheckError wr_check_error(const WrCheck *check, const float *a, const float *b, bool raised)
{
    double sum = 0, squares = 0, n = check->count;
    float most = 0;
    for (int i = 0; i < check->count; i++) {
        double own = 0;
        for (size_t end = BLOCK_FLOATS; end > 0; end -= 4, a += 4, b += 4)
            for (int c = 0; c < 3; c++) {
                const float d = isfinite(a[c] - b[c]) ? a[c] - b[c] : 0;
                own += (double)(d * d);
                most = fmaxf(most, fabsf(d));
            }
        own *= check->weight[i];
        sum += own;
        squares += own * own;
    }
    raised = raised && !check->all;
    if (raised && n > 1)
        sum += UNCERTAINTY * sqrt(fmax(0, (squares - sum * sum / n) * n / (n - 1)));
    return (WrCheckError){ sqrt(sum / (3 * fmax(1, check->study->covered))),
                           (raised ? UNSEEN_MAX : 1) * (double)most };
}
