/* Error estimate of a block from the change between levels, and tests of a few blocks at a much finer level, in
   case two levels agree on a wrong value. */
#include "accuracy/tolerance_internal.h"
#include "base/error.h"
#include "base/memory.h"
#include "scene/objects.h"
#include "system/clock.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Factor that corrects predictions, with a safety margin, from the actual errors divided by the predicted ones,
   each raised by a floor that adds up to half of all predictions. shares, squares: sum of the ratios, and of
   their squares. */
static double study_factor(double shares, double squares, int64_t count);

/* ---- Blocks of a picture, each with its pictures at increasing levels ---- */

/* block->rgba[level] is BLOCK x BLOCK x 4 floats, rows of 4 BLOCK, or NULL if the block was not rendered at
   that level or its picture was dropped: only the last two levels are kept. change[level] compares it with the
   level below. */
#define BLOCK WR_FRAME_BLOCK

/* ---- blocks of pixels ---- */

static Corner study_corner(const Study *study, int64_t block)
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
    const Corner at = study_corner(study, block);
    const size_t wide = (size_t)study->request->width;
    if (at.w < BLOCK || at.h < BLOCK) memset(out, 0, BLOCK_FLOATS * sizeof *out);
    for (int y = 0; y < at.h; y++)
        memcpy(out + (size_t)4 * BLOCK * (size_t)y,
               study->frame->rgba + 4 * ((size_t)(at.y + y) * wide + (size_t)at.x),
               (size_t)at.w * 4 * sizeof *out);
}

static void put(const Study *study, int64_t block, const float *rgba)
{
    const Corner at = study_corner(study, block);
    const size_t wide = (size_t)study->request->width;
    for (int y = 0; y < at.h; y++)
        memcpy(study->frame->rgba + 4 * ((size_t)(at.y + y) * wide + (size_t)at.x),
               rgba + (size_t)4 * BLOCK * (size_t)y, (size_t)at.w * 4 * sizeof *rgba);
}

/* Sums of a row in float, of rows in double: the inner loop vectorises, and a short sum loses no digits that
   matter. */
static Change block_change(const float *a, const float *b)
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

/* Compares a block's pictures of a level and the one below: sets block->change and block->side of that level. */
static void block_compare(Block *block, int level)
{
    const float *a = block->rgba[level - 1], *b = block->rgba[level];
    const size_t row = (size_t)4 * BLOCK;
    Change *side = block->side[level];
    block->change[level] = block_change(a, b);
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
static int study_look(const Study *study, int64_t b)
{
    Block *block = &study->block[b];
    const Corner at = study_corner(study, b);
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
static int study_look_around(const Study *study, int64_t b)
{
    const Corner at = study_corner(study, b);
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
   1/2 where two blocks meet there, of which one has the error.
   An outline parallel to the pixels has equal coverage in all pixels along it, so its error has one sign and
   does not average out: k samples across resolve coverage to 1/k, with an error of up to 1/(2k) of the step. */
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
   middle of five in a row.
   The colours of five pixels in a row, p0 .. p4; the slopes on both sides are continued to the middle, and the
   rest of p3 - p1 is the step. `part` is where in the middle pixel it lies, from the share of the step already
   reached at p2. */
typedef struct Jump {
    double step[3], sum, part;
} Jump;

/* A step smaller than the slopes around it is taken for shading. */
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
   next row has its step within less than half the distance of samples, the crease is parallel to the pixels.
   part is a distance in pixels; in both rows within 1 / (2k), and no k x k grid can tell the crease's place
   from one row to the next. */
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
    const Corner at = study_corner(study, b);
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

/* All levels use regular samples: with random ones two levels would differ by noise and not by resolution. */

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

/* The time of `prepare` (tables, meshes) is paid once and not part of the price of samples. */
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

/* Renders the blocks of study->mask at a level with a pair. keep: stores their pictures of that level; else into
   `out`, BLOCK_FLOATS for each of them in order, or, if that is NULL too, only into study->frame.
   step[level] needs the neighbours' pictures of the same pass, hence the second loop. */
static bool study_render(Study *study, int pair, int level, bool keep, float *out, WrError *err)
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

static void study_drop(Block *block, int level)
{
    wr_free(block->rgba[level]);
    block->rgba[level] = NULL;
}

/* Levels from the top down: a block that climbs in this call then has a level that the loop has already
   passed. */
bool wr_study_climb(Study *study, const unsigned char *wanted, WrError *err)
{
    /* From above, so that no block climbs twice. */
    for (int level = TOP - 1; level >= 0; level--)
        for (int pair = 0; pair < study->pairs; pair++) {
            if (mask_climbers(study, wanted, pair, level) == 0) continue;
            if (!study_render(study, pair, level + 1, true, NULL, err)) return false;
            for (int64_t b = 0; b < study->count; b++) {
                Block *block = &study->block[b];
                if (!study->mask[b]) continue;
                block_compare(block, level + 1);
                block->level = (signed char)(level + 1);
                if (level > 0) study_drop(block, level - 1); /* no block goes down two levels */
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

/* One sample a pixel suffices for the difference between two formulas: their sampling errors are nearly equal
   and cancel. */
bool wr_study_formula(Study *study, int pair, WrError *err)
{
    float taken[BLOCK_FLOATS];
    for (int64_t b = 0; b < study->count; b++) study->mask[b] = study->block[b].shown;
    if (!study_render(study, pair, 0, false, NULL, err)) return false;
    for (int64_t b = 0; b < study->count; b++) {
        Block *block = &study->block[b];
        if (!block->shown) continue;
        take(study, b, taken);
        block->formula[pair] = block_change(taken, block->rgba[0]);
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
            if (found > 0 && !study_render(study, pair, level, true, NULL, err)) return false;
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

/* ---- tolerance survey ---- */

/* First survey of a picture: one sample a pixel everywhere, 2 x 2 at outlines and on a few of the insides. The
   change by 2 x 2 on the others is predicted from the differences of neighbouring pixels, which are small on
   smooth insides: most of a calm picture is never rendered a second time. */

/* One inside of this many is rendered at 2 x 2, to calibrate the predictions of the others. */
#define LOOKED_AT 10
#define LOOKED_MIN 12
#define LIVELIER 16.0 /* ratio of predicted squares from which a neighbour counts as lively */
#define LIVELIEST 6   /* in root mean squares: predicted largest error of a block's pixels */

/* The default mesh has an outline error of up to a quarter of a pixel, typically a twentieth, which samples
   cannot reduce; each step of the dial reduces it to a quarter. Largest part of the tolerance that it may use: */
#define MESH_OFF 0.05
#define MESH_PART 0.3
#define FINE_MESH 2

/* ---- the surface's mesh ---- */

static bool mesh_matters(const Study *study)
{
    const WrDial *mesh = &wr_dials[WR_DIAL_MESH];
    return !mesh->matters || mesh->matters(study->request->scene);
}

/* Squares caused in a block by an outline error of one pixel.
   An outline that moves by one pixel changes that pixel by the object's full colour. */
static double outline_squares(const Study *study, int64_t b)
{
    const Corner at = study_corner(study, b);
    const float *rgba = study->block[b].rgba[0];
    double sum = 0;
    for (int y = 0; y < at.h; y++)
        for (int x = 0; x < at.w; x++) {
            const float *p = rgba + (size_t)4 * (size_t)(y * BLOCK + x);
            const bool right = x + 1 < at.w && (p[3] > 0) != (p[7] > 0);
            const bool down = y + 1 < at.h && (p[3] > 0) != (p[4 * BLOCK + 3] > 0);
            if (!right && !down) continue;
            const float *in = p[3] > 0 ? p : right ? p + 4 : p + (size_t)4 * BLOCK;
            for (int c = 0; c < 3; c++) sum += (double)in[c] * (double)in[c];
        }
    return sum;
}

/* Uses a finer mesh from the second level on, if the default mesh would use a significant part of the tolerance. */
static void choose_mesh(Study *study, const WrTolerance *tolerance)
{
    double sum = 0;
    int64_t covered = 0;
    if (tolerance->kind != WR_TOLERANCE_RMS || !mesh_matters(study)) return;
    for (int64_t b = 0; b < study->count; b++) {
        sum += outline_squares(study, b);
        covered += study->block[b].covered;
    }
    const double rms = MESH_OFF * sqrt(sum / (3 * fmax(1, (double)covered)));
    study->mesh_from = 1;
    while (study->mesh < FINE_MESH && rms > MESH_PART * tolerance->value * (1 << 2 * study->mesh))
        study->mesh++;
}

/* ---- prediction of the change by 2 x 2 ---- */

/* For f with second derivative f'' per pixel the four samples at +-1/4 have the mean f + f''/32 per axis.
   `rough` = second^2 / (5 first^2) is 1 for white noise: a Laplacian has 20 times the variance of a value, two
   first differences 4 times. */

/* The mean of 2 x 2 differs from the pixel's centre by 1/32 of the pixels' second difference if the picture is
   smooth, by 1/4 of it if the pixels are independent; the ratio of the second to the first difference
   distinguishes them. */
static double foretell(const float *rgba)
{
    double first = 0, second = 0;
    for (int y = 1; y + 1 < BLOCK; y++)
        for (int x = 1; x + 1 < BLOCK; x++) {
            const float *p = rgba + (size_t)4 * (size_t)(y * BLOCK + x);
            for (int c = 0; c < 3; c++) {
                const float right = p[4 + c] - p[c], left = p[c - 4] - p[c];
                const float down = p[4 * BLOCK + c] - p[c], up = p[c - 4 * BLOCK] - p[c];
                const float bend = right + left + down + up;
                first += (double)(right * right + down * down);
                second += (double)(bend * bend);
            }
        }
    if (!(first > 0)) return 0;
    const double rough = fmin(1, second / (5 * first));
    const double inner = (double)((BLOCK - 2) * (BLOCK - 2)) / (BLOCK * BLOCK);
    return second / inner * fmax(1.0 / 1024, rough / 16);
}

/* Finds insides that may be predicted: without an outline in them or next to them. Sets them to 0 in
   study->mask, all others to 1. If the largest error counts, every block is rendered. */
static int64_t find_insides(Study *study, const WrTolerance *tolerance)
{
    int64_t found = 0;
    for (int64_t b = 0; b < study->count; b++) {
        study->mask[b] = study_look(study, b) != OBJECT || tolerance->kind == WR_TOLERANCE_MAX ||
                         study->block[b].covered < BLOCK * BLOCK ||
                         study_look_around(study, b) != OBJECT;
        found += !study->mask[b];
    }
    return found;
}

typedef struct Inside {
    int64_t block;
    double off;
} Inside;

static int by_off(const void *a, const void *b)
{
    const Inside *x = a, *y = b;
    if (x->off != y->off) return x->off < y->off ? -1 : 1;
    return (x->block > y->block) - (x->block < y->block);
}

/* Adds every n-th block, from calm to lively, to the mask, including the liveliest.
   Equal steps of the sorted list include calm and lively blocks alike; the ratio found holds for the
   whole range. */
static void look_at_some(Study *study, Inside *list, int64_t count)
{
    const int64_t wanted = count / LOOKED_AT > LOOKED_MIN ? count / LOOKED_AT : LOOKED_MIN;
    qsort(list, (size_t)count, sizeof *list, by_off);
    for (int64_t i = 0; i < wanted; i++)
        study->mask[list[count - 1 - i * count / wanted].block] = 1;
}

/* A calm block beside a lively one may contain the end of the feature that makes it lively, between its pixels'
   centres. */
static void look_beside_lively(Study *study, const Inside *list, int64_t count)
{
    double *off = wr_alloc((size_t)study->count, sizeof *off), sum = 0;
    for (int64_t i = 0; i < count; i++) sum += off[list[i].block] = list[i].off;
    for (int64_t i = 0; i < count; i++) {
        const int u = (int)(list[i].block % study->blocks_u);
        const int v = (int)(list[i].block / study->blocks_u);
        for (int n = 0; n < 9; n++) {
            const int other_u = u + n % 3 - 1, other_v = v + n / 3 - 1;
            if (other_u < 0 || other_v < 0 || other_u >= study->blocks_u ||
                other_v >= study->blocks_v)
                continue;
            const double beside = off[(int64_t)other_v * study->blocks_u + other_u];
            if (beside * (double)count > sum && beside > LIVELIER * list[i].off)
                study->mask[list[i].block] = 1;
        }
    }
    wr_free(off);
}

/* Corrects the predictions of the others by the results of those rendered.
   Each ratio is result / (prediction + floor): the floor, half the mean prediction, keeps a few blocks with
   tiny predictions from dominating. study_factor undoes its mean effect (1.5). */
static void correct(Study *study, const Inside *list, int64_t count)
{
    double sum = 0, shares = 0, squares = 0;
    int64_t seen = 0;
    for (int64_t i = 0; i < count; i++) sum += list[i].off;
    const double floor_off = 0.5 * sum / (double)count + 1e-15;
    for (int64_t i = 0; i < count; i++) {
        const Block *block = &study->block[list[i].block];
        if (!block->rgba[1]) continue;
        const double share =
            block_change(block->rgba[0], block->rgba[1]).squares / (list[i].off + floor_off);
        shares += share;
        squares += share * share;
        seen++;
    }
    const double factor = study_factor(shares, squares, seen) / 1.5;
    for (int64_t i = 0; i < count; i++) {
        Block *block = &study->block[list[i].block];
        const double off = factor * (list[i].off + floor_off);
        if (!block->rgba[1])
            block->change[1] = (Change){ off, LIVELIEST * sqrt(off / (3.0 * BLOCK * BLOCK)) };
    }
}

/* ---- block contents and outlines ---- */

/* An outline that passes beside a block may cut a corner of it that neither picture hit: the change of one row
   of the liveliest neighbour may be hidden there. */
static void doubt_corner(Study *study, int64_t b)
{
    const int u = (int)(b % study->blocks_u), v = (int)(b / study->blocks_u);
    Change *own = &study->block[b].change[1];
    for (int j = v > 0 ? v - 1 : 0; j <= v + 1 && j < study->blocks_v; j++)
        for (int i = u > 0 ? u - 1 : 0; i <= u + 1 && i < study->blocks_u; i++) {
            const Block *other = &study->block[(int64_t)j * study->blocks_u + i];
            if (!other->lined) continue;
            own->most = fmax(own->most, other->change[1].most);
            own->squares = fmax(own->squares, other->change[1].squares / BLOCK);
        }
}

/* Determines each block's content and frees the empty ones.
   Blocks are decided by the coverage of 1 x 1 and 2 x 2 samples, their own and that of the pixels around. */
static void sort_blocks(Study *study)
{
    unsigned char *seen = wr_alloc((size_t)study->count, 1);
    study->pixels = 0;
    for (int64_t b = 0; b < study->count; b++) seen[b] = (unsigned char)study_look(study, b);
    for (int64_t b = 0; b < study->count; b++) {
        Block *block = &study->block[b];
        block->edge = (seen[b] | study_look_around(study, b)) == (NOTHING | OBJECT);
        block->shown = block->edge || seen[b] == OBJECT;
        block->lined = seen[b] == (NOTHING | OBJECT);
        block->level = block->rgba[1] != NULL;
        if (block->level > 0) block_compare(block, 1);
        study->pixels += block->covered;
    }
    for (int64_t b = 0; b < study->count; b++)
        if (study->block[b].edge && !study->block[b].lined) doubt_corner(study, b);
    for (int64_t b = 0; b < study->count; b++)
        for (int level = 0; level < 2 && !study->block[b].shown; level++)
            study_drop(&study->block[b], level);
    wr_free(seen);
}

/* ---- interface ---- */

bool wr_study_begin(Study *study, const WrTolerance *tolerance, WrError *err)
{
    if (tolerance->kind == WR_TOLERANCE_MAX && mesh_matters(study)) study->mesh = FINE_MESH;
    for (int64_t b = 0; b < study->count; b++) study->mask[b] = 1;
    return study_render(study, 0, 0, true, NULL, err);
}

/* Part of the samples that are beside those of the first picture: outlines. */
#define BESIDE 1.1

/* If fixed costs of the passes exceed the price of the finest level for all blocks, no choice can pay. */
bool wr_study_best_is_cheaper(const Study *study, const WrTolerance *tolerance)
{
    const double side = wr_level_side(TOP), seen = (double)study->shaded;
    const double pass = wr_price_pass((int64_t)study->request->width * study->request->height);
    const double best = BESIDE * study->pair[0].price * side * side * seen + pass;
    if (tolerance->kind == WR_TOLERANCE_TIME) return best <= tolerance->value;
    /* 2 x 2, one step up from there, a probe of each; no time per sample. */
    return seen > 0 && best <= 4 * pass;
}

bool wr_study_take_best(Study *study, WrError *err)
{
    for (int64_t b = 0; b < study->count; b++) study->mask[b] = 1;
    study->mesh = mesh_matters(study) ? FINE_MESH : study->mesh;
    if (!study_render(study, 0, TOP, true, NULL, err)) return false;
    study->pixels = 0;
    for (int64_t b = 0; b < study->count; b++) {
        Block *block = &study->block[b];
        /* The finest level shows outlines: it stands for the second level, which was not rendered. */
        block->rgba[1] = block->rgba[TOP];
        const int seen = study_look(study, b);
        block->rgba[1] = NULL;
        block->shown = (seen & OBJECT) != 0;
        block->edge = block->lined = seen == (NOTHING | OBJECT);
        block->change[1] = block_change(block->rgba[0], block->rgba[TOP]);
        block->level = 1;
        block->pick = TOP;
        block->step[1] = block->step[TOP];
        study->pixels += block->covered;
    }
    return true;
}

bool wr_study_survey(Study *study, const WrTolerance *tolerance, WrError *err)
{
    const int64_t count = find_insides(study, tolerance);
    const bool some = count > (int64_t)LOOKED_MIN;
    Inside *list = wr_alloc((size_t)count + 1, sizeof *list);
    int64_t n = 0;
    for (int64_t b = 0; b < study->count; b++)
        if (!study->mask[b]) list[n++] = (Inside){ b, foretell(study->block[b].rgba[0]) };
    choose_mesh(study, tolerance);
    if (some) {
        look_at_some(study, list, count);
        look_beside_lively(study, list, count);
    }
    for (int64_t b = 0; b < study->count && !some; b++) study->mask[b] = 1;
    const bool good = study_render(study, 0, 1, true, NULL, err);
    if (good && some) correct(study, list, count);
    if (good) sort_blocks(study);
    wr_free(list);
    return good;
}

/* Error relative to c, the square of the change from k to 2k samples a side, if errors fall as k^-p:
     outlines, p = 3/2   the finer has 1/9 of c if both are independent, 0.3 if they have the same sign;
     noise finer than the samples, p = 1   1/5;   smooth, p = 2   1/9, and the coarser 16/9.
   The fall of c from one step to the next distinguishes them roughly: by 8, by 4, by 16.
   c = (e_k - e_2k)^2 with e ~ k^-p. For equal signs e_2k^2 / c = 1 / (2^p - 1)^2: p = 2 yields 1/9, p = 3/2
   yields 0.3; for independent errors 1 / (2^2p + 1): p = 3/2 yields 1/9, p = 1 yields 1/5. */
#define FINER 0.18
#define COARSER_MIN 1.0
#define COARSER_MAX 1.8
#define FALL 8.0 /* of c from one step to the next: assumed for prediction ... */
#define FALL_MAX                                                                                   \
    2.0 /* ... and for the largest of many pixels, which falls more slowly than the mean */
#define FELL 14.0 /* largest credible fall: a smaller step than that is chance */
#define FELL_MAX 3.0
static const double finer_most[LEVELS] = { 0, 0.85, 0.85, 0.75, 0.7 };

/* The actual errors of blocks that climbed correct the estimates of the others: from this number on, within
   these bounds. */
#define LEARNT_MIN 6
#define LEARNT_LOW 0.4
#define LEARNT_HIGH 4.0

#define HIDDEN 0.125 /* part of the squares along a side of a neighbour: one of its BLOCK pixels */

/* Probing: the picks, the level of each probe, and the share of the picture's cost for all of them. */
#define PROBED 3
static const int probe_level[PROBED] = { 2, 3, 3 };
#define PROBING 0.25
#define GROWN 1.5   /* probing is repeated when the number of blocks has grown by this factor */
#define CAUTION 1.0 /* standard errors added to a ratio of the sample */
#define FEW 4       /* with fewer probes a ratio is uncertain: only large deviations count */
#define FAR 2.0
#define LEAST_WEIGHT 0.7
#define MAX_WEIGHT 1000.0
#define WORSE 1.15 /* a larger factor requires a new pick */

/* ---- error of a block ---- */

static Change larger(Change a, Change b)
{
    return (Change){ fmax(a.squares, b.squares), fmax(a.most, b.most) };
}

static Change times(Change a, double squares, double most)
{
    return (Change){ a.squares * squares, a.most * most };
}

/* At a level: by the step to it, but at least the prediction of the steps before. */
static Change predicted(const Block *block, int level)
{
    if (level == 0) return times(block->change[1], COARSER_MIN, 1);
    Change off = block->step[level];
    double fall = FINER, fall_most = finer_most[level];
    for (int n = level; n >= 1; n--) {
        off = larger(off, times(block->change[n], fall, fall_most));
        fall /= FELL;
        fall_most /= FELL_MAX;
    }
    return off;
}

/* Factor from the step from a level to the next.
   c falls by 16 for p = 2: there the coarser error is (4/3)^2 c = 16/9 c; by 8 or less it is about c. */
static double coarser(const Block *block, int level)
{
    const double before = block->change[level].squares, after = block->change[level + 1].squares;
    if (level == 0 || !(after > 0)) return COARSER_MIN;
    return fmax(COARSER_MIN, fmin(COARSER_MAX, before / after / 9));
}

/* Prediction `above` levels higher, from the error here. */
static Change off_above(Change here, int above)
{
    return times(here, pow(1 / FALL, above), pow(1 / FALL_MAX, above));
}

/* At its own level, corrected by the results of others of its kind.
   `right` is the measured part of the predicted squares for blocks of the same level and kind that climbed on;
   one standard error is added. */
static Change off_here(const Study *study, const Block *block)
{
    const int level = block->level;
    const Learnt *learnt = &study->learnt[level][block->edge];
    const Change off = predicted(block, level);
    if (learnt->blocks < LEARNT_MIN || !(learnt->predicted > 0)) return off;
    const double caution = 1 + 1 / sqrt((double)learnt->blocks);
    const double right = caution * learnt->measured / learnt->predicted;
    return times(off, fmax(LEARNT_LOW, fmin(LEARNT_HIGH, right)), 1);
}

/* Change of a neighbour's pixels along the common side, or at the common corner, from the level below. At a
   level that it was not rendered at, half as much for each further level. */
static Change beside(const Block *other, int u, int v, int level)
{
    const int seen = level < 1 ? 1 : level < other->level ? level : other->level;
    if (seen == 0 || !other->shown) return (Change){ 0, 0 };
    const Change *across = &other->side[seen][u < 0 ? RIGHT : LEFT];
    const Change *along = &other->side[seen][v < 0 ? LOWER : UPPER];
    const Change common = u == 0   ? *along
                          : v == 0 ? *across
                                   : (Change){ fmin(across->squares, along->squares),
                                               fmin(across->most, along->most) };
    const int above = level > seen ? level - seen : 0;
    return times(common, pow(0.25, above), pow(0.5, above));
}

/* An edge of the picture that passes through a neighbour (an outline, a crease, the end of the relief or a pole)
   may end in a corner or along a side of this block where none of its samples hits it: then its own levels agree
   on the same wrong colour. The hidden error is at most the change of the neighbour's nearest pixels. */
static Change hidden(const Study *study, const Block *block, int level)
{
    const int64_t b = block - study->block;
    const int at_u = (int)(b % study->blocks_u), at_v = (int)(b / study->blocks_u);
    Change most = { 0, 0 };
    for (int v = -1; v <= 1; v++)
        for (int u = -1; u <= 1; u++) {
            if ((u == 0 && v == 0) || at_u + u < 0 || at_u + u >= study->blocks_u || at_v + v < 0 ||
                at_v + v >= study->blocks_v)
                continue;
            most = larger(most, beside(block + (int64_t)v * study->blocks_u + u, u, v, level));
        }
    return times(most, HIDDEN, 1);
}

/* From its own pictures only. */
static Change off_seen(const Study *study, const Block *block, int level)
{
    const Change here = off_here(study, block);
    if (level == block->level) return here;
    if (level < block->level) {
        const Change *next = &block->change[level + 1];
        return larger(block->step[level],
                      (Change){ coarser(block, level) * next->squares, next->most + here.most });
    }
    if (block->level == 0)
        return off_above(times(block->change[1], FINER, finer_most[1]), level - 1);
    const int above = level - block->level;
    const Change step = times(block->step[block->level], pow(0.25, above), pow(0.5, above));
    return larger(step, off_above(here, above));
}

static Change off_samples(const Study *study, const Block *block, int level)
{
    return larger(off_seen(study, block, level), hidden(study, block, level));
}

Change wr_study_off(const Study *study, const Block *block, int pair, int level)
{
    const Doubt *doubt = &study->doubt[level];
    const Change off = times(off_samples(study, block, level), doubt->weight, doubt->weight_most);
    const Change formula = pair > 0 ? block->formula[pair] : (Change){ 0, 0 };
    return (Change){ off.squares + formula.squares, off.most + formula.most };
}

void wr_study_learn(Study *study)
{
    memset(study->learnt, 0, sizeof study->learnt);
    for (int64_t b = 0; b < study->count; b++) {
        const Block *block = &study->block[b];
        for (int level = 1; block->shown && level < block->level; level++) {
            Learnt *learnt = &study->learnt[level][block->edge];
            learnt->predicted += predicted(block, level).squares;
            learnt->measured += coarser(block, level) * block->change[level + 1].squares;
            learnt->blocks++;
        }
    }
}

double wr_study_rms(const Study *study, double squares)
{
    return sqrt(squares / (3 * fmax(study->pixels, 1)));
}

/* ---- probes ---- */

typedef struct Probe {
    int64_t block;
    double off; /* estimated error, squares */
} Probe;

static int by_probe_error(const void *a, const void *b)
{
    const Probe *x = a, *y = b;
    if (x->off != y->off) return x->off < y->off ? -1 : 1;
    return (x->block > y->block) - (x->block < y->block);
}

/* All blocks of a pick, by increasing error. The caller frees. */
static Probe *list_picked(const Study *study, int pick, int64_t *count)
{
    Probe *list = wr_alloc((size_t)study->count + 1, sizeof *list);
    *count = 0;
    for (int64_t b = 0; b < study->count; b++) {
        const Block *block = &study->block[b];
        if (!block->shown || block->pick != pick) continue;
        list[(*count)++] = (Probe){ b, wr_study_off(study, block, block->pair, pick).squares };
    }
    qsort(list, (size_t)*count, sizeof *list, by_probe_error);
    return list;
}

/* Draws blocks at equal steps of the errors' cumulative sum, each raised by half the mean, so that blocks with
   small estimates are included. Puts them into the mask; returns their number. */
static int64_t draw(Study *study, const Probe *list, int64_t count, int64_t wanted,
                    double *floor_off)
{
    double sum = 0, passed = 0;
    int64_t drawn = 0;
    for (int64_t i = 0; i < count; i++) sum += list[i].off;
    *floor_off = 0.5 * sum / (double)count + 1e-15;
    sum += *floor_off * (double)count;
    for (int64_t b = 0; b < study->count; b++) study->mask[b] = 0;
    for (int64_t i = 0; i < count; i++) {
        passed += list[i].off + *floor_off;
        if (passed * (double)wanted < ((double)drawn + 0.5) * sum) continue;
        while (passed * (double)wanted >= ((double)drawn + 0.5) * sum) drawn++;
        study->mask[list[i].block] = 1;
    }
    drawn = 0;
    for (int64_t b = 0; b < study->count; b++) drawn += study->mask[b];
    return drawn;
}

/* Ratio of actual to estimated errors of the drawn blocks, each weighted by its drawing probability. */
typedef struct Ratio {
    double sum, squares;
    double most; /* ratio of the largest errors */
    int64_t count;
} Ratio;

static void add_probe(const Study *study, const Block *block, const float *fine, double floor_off,
                      Ratio *ratio)
{
    const Change off = wr_study_off(study, block, block->pair, block->pick);
    const Change seen = block_change(fine, block->rgba[block->pick]);
    const double share = seen.squares / (off.squares + floor_off);
    ratio->sum += share;
    ratio->squares += share * share;
    if (off.most > 0) ratio->most = fmax(ratio->most, seen.most / off.most);
    ratio->count++;
}

/* Converts shares of estimate and floor to a factor of the estimate: the floors add up to half of the
   estimates. The ratios' mean plus CAUTION standard errors of that mean; n - 1 in the denominator for the
   sample's variance. */
static double study_factor(double shares, double squares, int64_t count)
{
    const double n = (double)count, mean = shares / n;
    const double variance = fmax(0, squares / n - mean * mean) / fmax(1, n - 1);
    return 1.5 * (mean + CAUTION * sqrt(variance));
}

static double cautious(const Ratio *ratio)
{
    const double mean = ratio->sum / (double)ratio->count;
    if (ratio->count < FEW) return 1.5 * mean > FAR ? 1.5 * mean : 1;
    return study_factor(ratio->sum, ratio->squares, ratio->count);
}

static bool render_picks(Study *study, int pick, WrError *err)
{
    unsigned char *chosen = wr_alloc((size_t)study->count, 1);
    bool good = true;
    for (int64_t b = 0; b < study->count; b++) chosen[b] = study->mask[b];
    for (int pair = 0; good && pair < study->pairs; pair++) {
        int64_t missing = 0;
        for (int64_t b = 0; b < study->count; b++) {
            const Block *block = &study->block[b];
            study->mask[b] = chosen[b] && block->pair == pair &&
                             !(block->rgba[pick] && block->pair_of[pick] == pair);
            missing += study->mask[b];
        }
        good = missing == 0 || study_render(study, pair, pick, true, NULL, err);
    }
    for (int64_t b = 0; b < study->count; b++) study->mask[b] = chosen[b];
    wr_free(chosen);
    return good;
}

/* Number of probes: at least one; in total about PROBING of the picture's cost. */
static int64_t probes_wanted(const Study *study, int pick, int64_t count)
{
    const double side = wr_level_side(probe_level[pick]);
    const double one = study->pair[0].price * side * side * WR_FRAME_BLOCK * WR_FRAME_BLOCK;
    const int64_t worth = (int64_t)(PROBING / PROBED * wr_study_cost(study) / one);
    return worth < 1 ? 1 : worth < count ? worth : count;
}

static bool probe_pick(Study *study, int pick, bool *worse, WrError *err)
{
    int64_t count;
    double floor_off;
    Ratio ratio = { 0, 0, 0, 0 };
    Probe *list = list_picked(study, pick, &count);
    const int64_t wanted = (double)count > GROWN * (double)study->doubt[pick].blocks
                               ? probes_wanted(study, pick, count)
                               : 0;
    const int64_t drawn = wanted > 0 ? draw(study, list, count, wanted, &floor_off) : 0;
    wr_free(list);
    if (drawn == 0) return true;
    float *fine = wr_try_alloc((size_t)drawn * BLOCK_FLOATS, sizeof *fine, "blocks", err);
    bool good = fine && render_picks(study, pick, err) &&
                study_render(study, 0, probe_level[pick], false, fine, err);
    const float *at = fine;
    for (int64_t b = 0; good && b < study->count; b++) {
        if (!study->mask[b]) continue;
        add_probe(study, &study->block[b], at, floor_off, &ratio);
        at += BLOCK_FLOATS;
    }
    wr_free(fine);
    if (!good) return false;
    Doubt *doubt = &study->doubt[pick];
    doubt->blocks = count;
    const double factor = cautious(&ratio), before = doubt->weight;
    doubt->weight = fmax(LEAST_WEIGHT, fmin(MAX_WEIGHT, before * factor));
    doubt->weight_most *= fmax(1, ratio.most);
    *worse = *worse || factor > WORSE || ratio.most > WORSE;
    return true;
}

bool wr_study_probe(Study *study, bool *worse, WrError *err)
{

    *worse = false;
    for (int pick = 0; pick < PROBED; pick++)
        if (!probe_pick(study, pick, worse, err)) return false;
    return true;
}
