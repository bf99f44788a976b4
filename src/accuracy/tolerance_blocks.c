/* Blocks of a picture, each with its pictures at increasing levels. */
#include "accuracy/tolerance_internal.h"

#include "base/error.h"
#include "base/memory.h"
#include "scene/objects.h"
#include "system/clock.h"

#include <math.h>
#include <string.h>

#define BLOCK WR_FRAME_BLOCK

/* ---- blocks of pixels ---- */

Corner wr_study_corner(const Study *study, int64_t block)
{
    const WrFrameRequest *request = study->request;
    Corner at = { (int)(block % study->blocks_u) * BLOCK, (int)(block / study->blocks_u) * BLOCK, 0,
                  0 };
    at.w = request->width - at.x < BLOCK ? request->width - at.x : BLOCK;
    at.h = request->height - at.y < BLOCK ? request->height - at.y : BLOCK;
    return at;
}

/* Copies a block of the frame; 0 outside the picture. */
static void take(const Study *study, int64_t block, float *out)
{
    const Corner at = wr_study_corner(study, block);
    const size_t wide = (size_t)study->request->width;
    if (at.w < BLOCK || at.h < BLOCK) memset(out, 0, BLOCK_FLOATS * sizeof *out);
    for (int y = 0; y < at.h; y++)
        memcpy(out + (size_t)4 * BLOCK * (size_t)y,
               study->frame->rgba + 4 * ((size_t)(at.y + y) * wide + (size_t)at.x),
               (size_t)at.w * 4 * sizeof *out);
}

static void put(const Study *study, int64_t block, const float *rgba)
{
    const Corner at = wr_study_corner(study, block);
    const size_t wide = (size_t)study->request->width;
    for (int y = 0; y < at.h; y++)
        memcpy(study->frame->rgba + 4 * ((size_t)(at.y + y) * wide + (size_t)at.x),
               rgba + (size_t)4 * BLOCK * (size_t)y, (size_t)at.w * 4 * sizeof *rgba);
}

Change wr_block_change(const float *a, const float *b)
{
    Change out = { 0, 0 };
    float most = 0;
    for (size_t n = 0; n < BLOCK_FLOATS; n += (size_t)4 * BLOCK) {
        float row[3] = { 0 };
        for (size_t x = n; x < n + (size_t)4 * BLOCK; x += 4)
            for (size_t c = 0; c < 3; c++) {
                const float d = a[x + c] - b[x + c];
                row[c] += d * d;
                most = fabsf(d) > most ? fabsf(d) : most;
            }
        out.squares += (double)(row[0] + row[1] + row[2]);
    }
    out.most = (double)most;
    return out;
}

/* The part of a change along a side: BLOCK pixels from `first` on, `step` floats apart. */
static Change along(const float *a, const float *b, size_t first, size_t step)
{
    Change out = { 0, 0 };
    for (size_t n = 0; n < BLOCK; n++)
        for (size_t c = 0; c < 3; c++) {
            const double d = (double)a[first + n * step + c] - (double)b[first + n * step + c];
            out.squares += d * d;
            out.most = fmax(out.most, fabs(d));
        }
    return out;
}

void wr_block_compare(Block *block, int level)
{
    const float *a = block->rgba[level - 1], *b = block->rgba[level];
    const size_t row = (size_t)4 * BLOCK;
    Change *side = block->side[level];
    block->change[level] = wr_block_change(a, b);
    side[LEFT] = along(a, b, 0, row);
    side[RIGHT] = along(a, b, row - 4, row);
    side[UPPER] = along(a, b, 0, 4);
    side[LOWER] = along(a, b, row * (BLOCK - 1), 4);
}

/* ---- outlines and creases ---- */

/* For a crease parallel to the pixels: squared error of one pixel with one sample, relative to the squared step
   in colour. The worst case is 1/4, the mean over all its positions 1/12, shared by two pixels. */
#define CREASED (1.0 / 16)

/* Content of a pixel, from its coverages: the sample at its centre misses an edge that passes beside it, the
   others do not. */
static int look(float one, float two)
{
    return (one > 0 || two > 0 ? OBJECT : 0) | (one <= 0 || two < 1 ? NOTHING : 0);
}

/* Content of a block's pixel, from all pictures that it has. */
static int look_pixel(const Block *block, int x, int y)
{
    const size_t n = (size_t)4 * (size_t)(y * BLOCK + x) + 3;
    const float one = block->rgba[0][n];
    return look(one, block->rgba[1] ? block->rgba[1][n] : one);
}

/* Content of the block; also counts its pixels covered in the first picture. */
int wr_study_look(const Study *study, int64_t b)
{
    Block *block = &study->block[b];
    const Corner at = wr_study_corner(study, b);
    const float *one = block->rgba[0], *two = block->rgba[1] ? block->rgba[1] : one;
    int object = 0, nothing = 0, covered = 0;
    for (int y = 0; y < at.h; y++)
        for (int x = 0; x < at.w; x++) {
            const size_t n = (size_t)4 * (size_t)(y * BLOCK + x) + 3;
            covered += one[n] > 0;
            object |= (one[n] > 0) | (two[n] > 0);
            nothing |= (one[n] <= 0) | (two[n] < 1);
        }
    block->covered = covered;
    return (object ? OBJECT : 0) | (nothing ? NOTHING : 0);
}

/* Content of the pixels next to a block. */
int wr_study_look_around(const Study *study, int64_t b)
{
    const Corner at = wr_study_corner(study, b);
    int seen = 0;
    for (int y = at.y - 1; y <= at.y + at.h && seen != (NOTHING | OBJECT); y++) {
        const bool beside = y >= at.y && y < at.y + at.h;
        for (int x = at.x - 1; x <= at.x + at.w; x += beside ? at.w + 1 : 1) {
            if (x < 0 || y < 0 || x >= study->request->width || y >= study->request->height)
                continue;
            const Block *other = &study->block[(int64_t)(y / BLOCK) * study->blocks_u + x / BLOCK];
            seen |= look_pixel(other, x % BLOCK, y % BLOCK);
        }
    }
    return seen;
}

/* Adds the possible error of k x k samples where the outline steps from p to the next pixel across it and does
   the same in the row beside: at most 1/(2k) of the object's colour. share: 1, or
   1/2 where two blocks meet there, of which one has the error. */
static void add_step(const float *p, const float *across, const float *p_beside,
                     const float *across_beside, int k, double share, Change *sum)
{
    if (p[3] == across[3] || p[3] != p_beside[3] || across[3] != across_beside[3]) return;
    const float *in = p[3] > across[3] ? p : across;
    for (int c = 0; c < 3; c++) {
        const double colour = fabs((double)in[c] / (double)in[3]);
        sum->squares += share * colour * colour / (4.0 * k * k);
        sum->most = fmax(sum->most, colour / (2.0 * k));
    }
}

/* A pixel of the picture at that level, or at the nearest that its block has; NULL: outside the picture, or its
   block has been freed, because it is far from the object. */
static const float *pixel_at(const Study *study, int x, int y, int level)
{
    if (x < 0 || y < 0 || x >= study->request->width || y >= study->request->height) return NULL;
    const Block *block = &study->block[(int64_t)(y / BLOCK) * study->blocks_u + x / BLOCK];
    int n = level;
    while (n > 0 && !block->rgba[n]) n--;
    while (n < TOP && !block->rgba[n]) n++;
    return block->rgba[n] ? block->rgba[n] + (size_t)4 * (size_t)(y % BLOCK * BLOCK + x % BLOCK)
                          : NULL;
}

/* The steps from the pixels of a block's border line to those across it, possibly of the next block; from (x, y)
   on, along (du, dv), `count` of them; (nu, nv) points across; share as in add_step. */
typedef struct Line {
    int x, y, du, dv, nu, nv, count;
    double share;
} Line;

static void add_line(const Study *study, const Line *line, int level, Change *sum)
{
    const int k = wr_level_side(level);
    for (int n = 0; n + 1 < line->count; n++) {
        const int x = line->x + n * line->du, y = line->y + n * line->dv;
        const float *p = pixel_at(study, x, y, level);
        const float *beside = pixel_at(study, x + line->du, y + line->dv, level);
        const float *across = pixel_at(study, x + line->nu, y + line->nv, level);
        const float *both =
            pixel_at(study, x + line->du + line->nu, y + line->dv + line->nv, level);
        if (across && both) add_step(p, across, beside, both, k, line->share, sum);
    }
}

/* The step in colour across a pixel beyond the neighbours' slopes, and the share of it before its mean: p is the
   middle of five in a row. */
typedef struct Jump {
    double step[3], sum, part;
} Jump;

static bool find_jump(const float *const p[5], Jump *out)
{
    double before = 0, slopes = 0;
    *out = (Jump){ { 0 }, 0, 0 };
    for (int i = 0; i < 5; i++)
        if (!p[i] || p[i][3] < 1) return false;
    for (int c = 0; c < 3; c++) {
        const double left = (double)(p[1][c] - p[0][c]), right = (double)(p[4][c] - p[3][c]);
        out->step[c] = (double)(p[3][c] - p[1][c]) - left - right;
        out->sum += out->step[c];
        before += (double)(p[2][c] - p[1][c]) - 0.5 * (left + right);
        slopes += fabs(left) + fabs(right);
    }
    if (fabs(out->sum) <= slopes || out->sum == 0) return false;
    out->part = before / out->sum;
    return true;
}

static bool jump_at(const Study *study, int x, int y, int du, int dv, int level, Jump *out)
{
    const float *p[5];
    for (int i = 0; i < 5; i++) p[i] = pixel_at(study, x + (i - 2) * du, y + (i - 2) * dv, level);
    return find_jump(p, out);
}

/* Adds a crease of the object, or an end of its relief: a step between two colours inside the object. If the
   next row has its step within less than half the distance of samples, the crease is parallel to the pixels. */
static void add_crease(const Study *study, int x, int y, int du, int dv, int level, Change *sum)
{
    const double k = wr_level_side(level);
    Jump here, next;
    if (!jump_at(study, x, y, du, dv, level, &here)) return;
    if (!jump_at(study, x + dv, y + du, du, dv, level, &next) &&
        !jump_at(study, x - dv, y - du, du, dv, level, &next))
        return;
    if (here.sum * next.sum < 0 || fabs(here.part - next.part) * k > 0.5) return;
    for (int c = 0; c < 3; c++) {
        sum->squares += CREASED * here.step[c] * here.step[c] / (k * k);
        sum->most = fmax(sum->most, fabs(here.step[c]) / (2 * k));
    }
}

/* Possible error of outlines or creases parallel to the rows or columns. Every pixel along them has the same
   coverage or colour, so two levels can agree on a wrong value. One between two blocks is counted in both:
   either may contain the part of a pixel that no sample hits. */
static Change aligned(const Study *study, int64_t b, int level)
{
    const Corner at = wr_study_corner(study, b);
    Change sum = { 0, 0 };
    for (int x = -1; x < at.w; x++) {
        const bool between = x < 0 || x + 1 == at.w;
        add_line(study,
                 &(Line){ .x = at.x + (x < 0 ? 0 : x),
                          .y = at.y,
                          .dv = 1,
                          .nu = x < 0 ? -1 : 1,
                          .count = at.h,
                          .share = between ? 0.5 : 1 },
                 level, &sum);
    }
    for (int y = -1; y < at.h; y++) {
        const bool between = y < 0 || y + 1 == at.h;
        add_line(study,
                 &(Line){ .x = at.x,
                          .y = at.y + (y < 0 ? 0 : y),
                          .du = 1,
                          .nv = y < 0 ? -1 : 1,
                          .count = at.w,
                          .share = between ? 0.5 : 1 },
                 level, &sum);
    }
    for (int y = at.y; y < at.y + at.h; y++)
        for (int x = at.x; x < at.x + at.w; x++) {
            add_crease(study, x, y, 1, 0, level, &sum);
            add_crease(study, x, y, 0, 1, level, &sum);
        }
    return sum;
}

/* ---- frames ---- */

WrScene *wr_level_scene(const WrScene *of, WrScheme scheme, WrBumpMode mode, int level, int mesh)
{
    WrScene *scene = wr_scene_clone(of);
    scene->scheme = scheme;
    scene->bump = mode;
    wr_scene_set_all_slopes(scene, true, true);
    scene->dials.aa = level > 0 ? WR_AA_SUPERSAMPLE : WR_AA_POINT;
    scene->dials.samples = wr_level_side(level);
    scene->dials.spread = WR_SPREAD_REGULAR;
    scene->dials.mesh = mesh;
    scene->tolerance = (WrTolerance){ WR_TOLERANCE_NONE, 0 };
    return scene;
}

WrScene *wr_study_scene(const Study *study, int pair, int level)
{
    const WrScene *scene = study->request->scene;
    const bool finer = level >= study->mesh_from && scene->dials.mesh < study->mesh;
    return wr_level_scene(scene, study->pair[pair].scheme, study->pair[pair].mode, level,
                          finer ? study->mesh : scene->dials.mesh);
}

static bool render(Study *study, int pair, int level, const unsigned char *only, WrError *err)
{
    WrScene *scene = wr_study_scene(study, pair, level);
    WrFrameRequest request = *study->request;
    request.scene = scene;
    request.dials = NULL;
    request.only = only;
    request.keep = false;
    request.hold = true;
    request.normals = NULL;
    const double start = wr_clock_seconds();
    const bool good = wr_renderer_frame(study->renderer, &request, study->frame, err);
    const double wall = wr_clock_seconds() - start;
    wr_scene_free(scene);
    if (!good) return false;
    const WrStageTimes *times = &study->frame->times;
    study->seconds += wall - fmin(times->prepare, wall);
    study->spent += study->pair[pair].price * (double)study->frame->shaded +
                    wr_price_pass((int64_t)study->request->width * study->request->height);
    study->shaded += study->frame->shaded;
    study->frames++;
    wr_times_add(&study->times, times);
    wr_plan_add(&study->plan, study->frame->plan);
    return true;
}

static bool keep_block(Study *study, int64_t b, int pair, int level, WrError *err)
{
    Block *block = &study->block[b];
    if (!block->rgba[level])
        block->rgba[level] = wr_try_alloc(BLOCK_FLOATS, sizeof(float), "a block", err);
    if (!block->rgba[level]) return false;
    take(study, b, block->rgba[level]);
    block->pair_of[level] = (signed char)pair;
    return true;
}

bool wr_study_render(Study *study, int pair, int level, bool keep, float *out, WrError *err)
{
    if (!render(study, pair, level, study->mask, err)) return false;
    for (int64_t b = 0; b < study->count; b++) {
        if (!study->mask[b]) continue;
        if (keep && !keep_block(study, b, pair, level, err)) return false;
        if (!keep && out) {
            take(study, b, out);
            out += BLOCK_FLOATS;
        }
    }
    for (int64_t b = 0; keep && b < study->count; b++)
        if (study->mask[b]) study->block[b].step[level] = aligned(study, b, level);
    return true;
}

/* ---- climbing ---- */

/* Puts the blocks of a pair that are at a level and need the next into the mask. Returns their number. The
   second level is rendered with the best pair, like the first: only the samples change between them. */
static int64_t mask_climbers(Study *study, const unsigned char *wanted, int pair, int level)
{
    int64_t found = 0;
    for (int64_t b = 0; b < study->count; b++) {
        const Block *block = &study->block[b];
        study->mask[b] =
            wanted[b] && block->level == level && pair == (level > 0 ? block->pair : 0);
        found += study->mask[b];
    }
    return found;
}

void wr_study_drop(Block *block, int level)
{
    wr_free(block->rgba[level]);
    block->rgba[level] = NULL;
}

bool wr_study_climb(Study *study, const unsigned char *wanted, WrError *err)
{
    /* From above, so that no block climbs twice. */
    for (int level = TOP - 1; level >= 0; level--)
        for (int pair = 0; pair < study->pairs; pair++) {
            if (mask_climbers(study, wanted, pair, level) == 0) continue;
            if (!wr_study_render(study, pair, level + 1, true, NULL, err)) return false;
            for (int64_t b = 0; b < study->count; b++) {
                Block *block = &study->block[b];
                if (!study->mask[b]) continue;
                wr_block_compare(block, level + 1);
                block->level = (signed char)(level + 1);
                if (level > 0) wr_study_drop(block, level - 1); /* no block goes down two levels */
            }
        }
    return true;
}

/* A step of the relief may end in a block between its pixels' centres, where one sample a pixel misses it: the
   change of one row of the liveliest neighbouring block may be hidden there. */
static void doubt_formula(Study *study, int pair)
{
    Change *beside = wr_alloc((size_t)study->count, sizeof *beside);
    for (int64_t b = 0; b < study->count; b++) {
        const int u = (int)(b % study->blocks_u), v = (int)(b / study->blocks_u);
        for (int n = 0; n < 9; n++) {
            const int x = u + n % 3 - 1, y = v + n / 3 - 1;
            if (x < 0 || y < 0 || x >= study->blocks_u || y >= study->blocks_v) continue;
            const Block *other = &study->block[(int64_t)y * study->blocks_u + x];
            if (!other->shown) continue;
            beside[b].squares = fmax(beside[b].squares, other->formula[pair].squares / BLOCK);
            beside[b].most = fmax(beside[b].most, other->formula[pair].most);
        }
    }
    for (int64_t b = 0; b < study->count; b++) {
        Change *own = &study->block[b].formula[pair];
        own->squares = fmax(own->squares, beside[b].squares);
        own->most = fmax(own->most, beside[b].most);
    }
    wr_free(beside);
}

bool wr_study_formula(Study *study, int pair, WrError *err)
{
    float taken[BLOCK_FLOATS];
    for (int64_t b = 0; b < study->count; b++) study->mask[b] = study->block[b].shown;
    if (!wr_study_render(study, pair, 0, false, NULL, err)) return false;
    for (int64_t b = 0; b < study->count; b++) {
        Block *block = &study->block[b];
        if (!block->shown) continue;
        take(study, b, taken);
        block->formula[pair] = wr_block_change(taken, block->rgba[0]);
    }
    doubt_formula(study, pair);
    return true;
}

/* ---- result ---- */

static bool is_missing(const Block *block)
{
    return block->shown &&
           !(block->rgba[block->pick] && block->pair_of[block->pick] == block->pair);
}

static bool render_missing(Study *study, WrError *err)
{
    for (int pair = 0; pair < study->pairs; pair++)
        for (int level = 0; level < LEVELS; level++) {
            int64_t found = 0;
            for (int64_t b = 0; b < study->count; b++) {
                const Block *block = &study->block[b];
                study->mask[b] = is_missing(block) && block->pair == pair && block->pick == level;
                found += study->mask[b];
            }
            if (found > 0 && !wr_study_render(study, pair, level, true, NULL, err)) return false;
        }
    return true;
}

bool wr_study_compose(Study *study, WrError *err)
{
    static const float nothing[BLOCK_FLOATS];
    if (!render_missing(study, err)) return false;
    for (int64_t b = 0; b < study->count; b++) {
        const Block *block = &study->block[b];
        put(study, b, block->shown ? block->rgba[block->pick] : nothing);
    }
    study->frame->covered = wr_frame_covered(study->frame);
    study->frame->shaded = study->shaded;
    study->frame->times = study->times;
    return true;
}

void wr_study_fini(Study *study)
{
    for (int64_t b = 0; study->block && b < study->count; b++)
        for (int level = 0; level < LEVELS; level++) wr_free(study->block[b].rgba[level]);
    wr_free(study->block);
    wr_free(study->mask);
    study->block = NULL;
    study->mask = NULL;
}
