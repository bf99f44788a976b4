#include "accuracy/illusion.h"

#include "base/error.h"
#include "base/memory.h"
#include "base/pool.h"
#include "base/progress.h"
#include "base/text.h"
#include "render/frame/frame.h"
#include "render/reference/reference_relief.h"
#include "render/visibility/view.h"
#include "scene/objects.h"
#include "scene/scene.h"

#include <math.h>
#include <string.h>

/* ---- Output of the illusion measurement: as sentences, as a table and as JSON ---- */

#define SEEN 0.5       /* pixels: smaller differences are invisible (E50) */
#define CODE 0.004     /* linear intensity: about one code of 255 at middle grey */
#define FULL_SCALE 0.1 /* linear intensity of full colour in the map, as in error pictures */

/* Red is the difference of coverage, green of shading, blue of shadow. */
void wr_illusion_colour(const WrIllusion *illusion, size_t pixel, uint8_t rgb[3])
{
    for (int c = 0; c < 3; c++) {
        const double value = (double)illusion->map[3 * pixel + (size_t)c] / (c ? FULL_SCALE : 1);
        rgb[c] = (uint8_t)lrint(255 * fmin(fmax(value, 0), 1));
    }
}

/* To first order displacement on screen is proportional to the height, so SEEN / moved of the present height
   moves points by half a pixel. */
void wr_illusion_height(const WrIllusion *illusion, WrText *text)
{
    const double moved = fmax(illusion->way, illusion->hausdorff); /* fmax ignores NAN */
    const bool shadows = illusion->shadow >= CODE;
    if (!(moved >= SEEN))
        wr_text_add(text, shadows ? "The difference is invisible here, except in shadows."
                                  : "The difference is invisible here.");
    else
        wr_text_addf(text, "Below height %.3g %s is invisible.",
                     fabs(illusion->bump_height) * SEEN / moved,
                     shadows ? "it here, but for shadows" : "the difference here");
}

static void add_outline(const WrIllusion *it, WrText *text)
{
    const double moved = it->hausdorff;
    if (!(moved >= 0)) {
        wr_text_add(text, "No outline is in the picture. ");
    } else if (moved < SEEN) {
        wr_text_addf(text, "The outline is %.2g pixels off at most, which is invisible. ", moved);
    } else {
        wr_text_addf(text, "The outline is up to %.3g pixels off. ", moved);
        if (it->rise > 0)
            wr_text_addf(text, "Below height %.3g no point moves by half a pixel. ",
                         fabs(it->bump_height) * SEEN / it->rise);
    }
}

static void add_inside(const WrIllusion *it, WrText *text)
{
    if (it->common == 0) return;
    if (it->way < SEEN)
        wr_text_addf(text, "Places are %.2g pixels from where bump shows them at most. ", it->way);
    else
        wr_text_addf(
            text,
            "Places are %.2g pixels from where bump shows them, %.2g at most: below height "
            "%.3g not half a pixel. ",
            it->way_mean, it->way, fabs(it->bump_height) * SEEN / it->way);
    if (it->shadow < CODE) wr_text_add(text, "Shadows of the relief make no difference.");
    else if (it->shadow > it->shading)
        wr_text_add(text, "Most of it is shadow: material shadow=on adds that to bump mapping.");
    else wr_text_add(text, "Shadow is the smaller part: most of the difference is in visibility.");
}

void wr_illusion_advice(const WrIllusion *illusion, WrText *text)
{
    wr_illusion_height(illusion, text);
    wr_text_add(text, " ");
    add_outline(illusion, text);
    add_inside(illusion, text);
}

/* NaN, where there is no outline, becomes null in JSON. */
typedef struct Number {
    const char *name, *words;
    double value;
} Number;

#define NUMBERS 11
static void numbers_of(const WrIllusion *it, Number out[NUMBERS])
{
    const Number numbers[NUMBERS] = {
        { "outline", "outline, pixels of area", it->outline },
        { "outline_mean", "the same over its length", it->outline_mean },
        { "hausdorff", "farthest from the other", it->hausdorff },
        { "perimeter", "length of bump's outline", it->perimeter },
        { "shading", "shading, rms at the same pixel", it->shading },
        { "shading_at", "rms at the same u and v", it->shading_at },
        { "shadow", "shadow, rms", it->shadow },
        { "all", "shading and shadow, rms", it->all },
        { "moved_mean", "places moved, mean pixels", it->way_mean },
        { "moved_most", "places moved, at most", it->way },
        { "rise", "displacement by F at most, pixels", it->rise },
    };
    for (int i = 0; i < NUMBERS; i++) out[i] = numbers[i];
}

void wr_illusion_text(const WrIllusion *illusion, const char *name, WrText *text)
{
    Number numbers[NUMBERS];
    numbers_of(illusion, numbers);
    wr_text_addf(text, "%s%s%d x %d pixels: bump mapping beside displacement\n\n", name,
                 name[0] ? ", " : "", illusion->width, illusion->height);
    for (int i = 0; i < NUMBERS; i++)
        wr_text_addf(text, "%-32s %10.4g\n", numbers[i].words, numbers[i].value);
    wr_text_add(text, "\n");
    wr_illusion_advice(illusion, text);
    wr_text_add(text, "\n");
}

void wr_illusion_json(const WrIllusion *illusion, const char *name, WrText *text)
{
    Number numbers[NUMBERS];
    WrText advice = { 0 };
    numbers_of(illusion, numbers);
    wr_illusion_advice(illusion, &advice);
    wr_text_add(text, "{\"document\":");
    wr_text_add_json_string(text, name);
    wr_text_addf(text, ",\"width\":%d,\"height\":%d", illusion->width, illusion->height);
    for (int i = 0; i < NUMBERS; i++) {
        wr_text_addf(text, ",\"%s\":", numbers[i].name);
        wr_text_add_json_number(text, numbers[i].value);
    }
    wr_text_add(text, ",\"advice\":");
    wr_text_add_json_string(text, wr_text_get(&advice));
    wr_text_add(text, "}\n");
    wr_text_fini(&advice);
}

/* Three pictures from one camera: B bumped, D0 displaced without shadows, D displaced with shadows. shading =
   rms(D0 - B) and shadow = rms(D - D0) on pixels that both cover whole; outline = the integral of |coverage
   difference|. The parts add up to D - B (NUMERICS-LIGHT d). */
#define SAMPLES 4    /* samples per side of a pixel */
#define FACETS 0.125 /* pixels: largest error of facets */
#define WHOLE 0.9999 /* minimum coverage of a pixel that is not on an outline */

/* ---- the three pictures ---- */

typedef enum Kind { BUMPED, RAISED, SHADOWED, KINDS } Kind;

typedef struct Pictures {
    const WrIllusionRequest *request;
    WrPool *pool;
    WrRenderer *renderer;
    float *rgba[KINDS]; /* owned */
} Pictures;

static void set_object(WrScene *object, Kind kind)
{
    object->displaced = kind != BUMPED;
    object->material.shadow = kind == SHADOWED;
}

/* All objects are changed alike, because an outline may lie between two of them. */
static WrScene *objects_of(const WrScene *scene, Kind kind)
{
    WrScene *made = wr_scene_clone(scene);
    for (int i = 0; i < wr_scene_object_count(made); i++) {
        if (i == made->chosen) continue;
        WrScene *other = wr_scene_clone(wr_scene_object(made, i));
        set_object(other, kind);
        wr_scene_set_object(made, i, other);
    }
    set_object(made, kind);
    return made;
}

/* The scene of a kind. All have the camera that fits the displaced one.
   The displaced object is larger; with a camera fitted to each picture the comparison would show the camera's
   motion. */
static WrScene *scene_of(const WrIllusionRequest *request, Kind kind)
{
    WrScene *made = objects_of(request->scene, kind), *raised = objects_of(request->scene, RAISED);
    wr_scene_hold_camera(made, raised, (double)request->width / request->height);
    wr_scene_free(raised);
    made->tolerance.kind = WR_TOLERANCE_NONE;
    made->dials.aa = WR_AA_SUPERSAMPLE;
    made->dials.samples = SAMPLES;
    made->dials.dice = FACETS;
    return made;
}

/* The frame's picture belongs to the renderer and is overwritten by the next kind: it is copied. */
static bool render(Pictures *p, Kind kind, WrError *err)
{
    const WrIllusionRequest *request = p->request;
    WrScene *scene = scene_of(request, kind);
    const WrFrameRequest wanted = { .field = request->field,
                                    .fields = request->fields,
                                    .scene = scene,
                                    .width = request->width,
                                    .height = request->height,
                                    .turn_deg = request->turn_deg,
                                    .cancel =
                                        request->progress ? request->progress->cancel : NULL };
    const size_t size = 4 * (size_t)request->width * (size_t)request->height;
    WrFrame frame;
    bool good = wr_renderer_frame(p->renderer, &wanted, &frame, err);
    p->rgba[kind] = good ? wr_try_alloc(size, sizeof(float), "a picture to compare", err) : NULL;
    good = p->rgba[kind] != NULL;
    if (good) memcpy(p->rgba[kind], frame.rgba, size * sizeof(float));
    wr_scene_free(scene);
    return good;
}

/* ---- outlines ---- */

/* Outside the picture coverage is 0, so that an object cut by the border has a closed outline. */
static double cover(const Pictures *p, Kind kind, int x, int y)
{
    const WrIllusionRequest *r = p->request;
    if (x < 0 || y < 0 || x >= r->width || y >= r->height) return 0;
    return (double)p->rgba[kind][4 * ((size_t)y * (size_t)r->width + (size_t)x) + 3];
}

/* Length of the outline: integral of the length of the coverage's gradient over the picture, from the four
   corners of each square of pixels.
   By the co-area formula the integral of |grad coverage| is the outline's length. The gradient at the corner
   of four pixels is ((b + d - a - c) / 2, (c + d - a - b) / 2). */
static double perimeter_of(const Pictures *p, Kind kind)
{
    double sum = 0;
    for (int y = -1; y < p->request->height; y++)
        for (int x = -1; x < p->request->width; x++) {
            const double a = cover(p, kind, x, y), b = cover(p, kind, x + 1, y);
            const double c = cover(p, kind, x, y + 1), d = cover(p, kind, x + 1, y + 1);
            sum += hypot(b + d - a - c, c + d - a - b) / 2;
        }
    return sum;
}

typedef struct Place {
    double x, y;
} Place;

/* Positions where coverage crosses one half between neighbours; out NULL: only their number.
   Linear interpolation between pixel centres; accurate to a small part of a pixel for 4 x 4 samples. */
static int crossings(const Pictures *p, Kind kind, Place *out)
{
    int count = 0;
    for (int y = 0; y < p->request->height; y++)
        for (int x = 0; x < p->request->width; x++)
            for (int down = 0; down < 2; down++) {
                const double a = cover(p, kind, x, y), b = cover(p, kind, x + !down, y + down);
                if ((a >= 0.5) == (b >= 0.5)) continue;
                const double t = (0.5 - a) / (b - a);
                if (out) out[count] = (Place){ x + (down ? 0 : t), y + (down ? t : 0) };
                count++;
            }
    return count;
}

/* The largest squared distance from a position of a to the nearest of b, at least `least`.
   The inner loop ends as soon as a position is known to be nearer than the largest distance so far:
   near-linear for similar outlines although quadratic in the worst case. */
static double farthest(const Place *a, int count, const Place *b, int others, double least)
{
    for (int i = 0; i < count; i++) {
        double nearest = INFINITY;
        for (int k = 0; k < others && nearest > least; k++) {
            const double x = a[i].x - b[k].x, y = a[i].y - b[k].y;
            nearest = fmin(nearest, x * x + y * y);
        }
        least = fmax(least, nearest);
    }
    return least;
}

/* Both directions: a bump of one outline is far from the other, but not vice versa. */
static double hausdorff(const Pictures *p)
{
    const int a = crossings(p, BUMPED, NULL), b = crossings(p, RAISED, NULL);
    if (a == 0 || b == 0) return NAN;
    Place *from = wr_alloc((size_t)a, sizeof *from), *to = wr_alloc((size_t)b, sizeof *to);
    crossings(p, BUMPED, from);
    crossings(p, RAISED, to);
    const double most = farthest(to, b, from, a, farthest(from, a, to, b, 0));
    wr_free(from);
    wr_free(to);
    return sqrt(most);
}

/* ---- measures ---- */

/* Mean over the three channels of the squared difference; `most` is the largest of them. */
static double squares(const float *a, const float *b, float *most)
{
    double sum = 0;
    *most = 0;
    for (int c = 0; c < 3; c++) {
        const float d = fabsf(a[c] - b[c]);
        *most = fmaxf(*most, d);
        sum += (double)d * (double)d / 3;
    }
    return sum;
}

/* Colours are compared only where both pictures cover a pixel whole: elsewhere the outline's difference would
   be counted twice. */
static void compare(const Pictures *p, WrIllusion *out)
{
    const size_t count = (size_t)out->width * (size_t)out->height;
    double shading = 0, shadow = 0, all = 0;
    for (size_t i = 0; i < count; i++) {
        const float *b = p->rgba[BUMPED] + 4 * i, *d0 = p->rgba[RAISED] + 4 * i;
        const float *d = p->rgba[SHADOWED] + 4 * i;
        float *map = out->map + 3 * i, most;
        map[0] = fabsf(b[3] - d[3]);
        out->outline += (double)map[0];
        if ((double)fminf(b[3], d[3]) < WHOLE) continue;
        out->common++;
        shading += squares(d0, b, &map[1]);
        shadow += squares(d, d0, &map[2]);
        all += squares(d, b, &most);
    }
    const double common = out->common > 0 ? (double)out->common : 1;
    out->shading = sqrt(shading / common);
    out->shadow = sqrt(shadow / common);
    out->all = sqrt(all / common);
    out->perimeter = perimeter_of(p, BUMPED);
    out->outline_mean = out->perimeter > 0 ? out->outline / out->perimeter : 0;
    out->hausdorff = hausdorff(p);
}

/* Measures the displacement of surface points.
   Follows each visible point of the displaced surface to the place where bump mapping shows the same (u, v). */
static bool follow(const Pictures *p, WrIllusion *out, WrError *err)
{
    const WrIllusionRequest *request = p->request;
    WrScene *scene = scene_of(request, RAISED);
    const WrReferenceRequest wanted = { .field = request->field,
                                        .fields = request->fields,
                                        .scene = scene,
                                        .width = request->width,
                                        .height = request->height,
                                        .turn_deg = request->turn_deg,
                                        .cancel =
                                            request->progress ? request->progress->cancel : NULL };
    WrMoved moved;
    const bool good = wr_reference_displacement_difference(&wanted, p->pool, &moved, err);
    if (good) {
        out->shading_at = moved.light_rms;
        out->way = moved.way_most, out->way_mean = moved.way_mean;
    }
    wr_scene_free(scene);
    return good;
}

static bool any_to_move(const WrIllusionRequest *request, WrError *err)
{
    const WrScene *scene = request->scene;
    for (int i = 0; i < wr_scene_object_count(scene); i++) {
        const WrScene *object = wr_scene_object(scene, i);
        if (!object->hidden && object->height != 0 && !wr_shape_unmoved(&object->shape))
            return true;
    }
    return wr_fail(err, "nothing to displace: needs a bump height other than 0, on a surface that "
                        "is neither a mesh nor endless");
}

static bool measure(Pictures *p, WrIllusion *out, WrError *err)
{
    const WrIllusionRequest *request = p->request;
    const size_t count = (size_t)request->width * (size_t)request->height;
    out->map = wr_try_alloc(count, 3 * sizeof *out->map, "the map", err);
    p->renderer = out->map ? wr_renderer_new(p->pool, request->isa, err) : NULL;
    if (!p->renderer) return false;
    for (int kind = 0; kind < KINDS; kind++) {
        if (!wr_progress_step(request->progress, 0.15 * kind)) return wr_fail(err, "cancelled");
        if (!render(p, (Kind)kind, err)) return false;
    }
    compare(p, out);
    return wr_progress_step(request->progress, 0.5) ? follow(p, out, err)
                                                    : wr_fail(err, "cancelled");
}

bool wr_illusion_measure(const WrIllusionRequest *request, WrIllusion *out, WrError *err)
{
    if (request->width < 1 || request->height < 1 || request->width > WR_ILLUSION_MAX ||
        request->height > WR_ILLUSION_MAX)
        return wr_fail(err, "a picture of %dx%d to compare: each side must be 1..%d",
                       request->width, request->height, WR_ILLUSION_MAX);
    if (!any_to_move(request, err)) return false;
    WrIllusion made = { .width = request->width,
                        .height = request->height,
                        .bump_height = request->scene->height,
                        .rise = -1 };
    Pictures p = { .request = request, .pool = wr_pool_new(request->threads) };
    const bool good =
        wr_view_rise(request->scene, request->field, wr_shape_radius(&request->scene->shape),
                     request->turn_deg, request->width, request->height, &made.rise, err) &&
        measure(&p, &made, err);
    wr_renderer_free(p.renderer);
    wr_pool_free(p.pool);
    for (int kind = 0; kind < KINDS; kind++) wr_free(p.rgba[kind]);
    wr_illusion_fini(out);
    if (good) *out = made;
    else wr_illusion_fini(&made);
    return good;
}

void wr_illusion_fini(WrIllusion *illusion)
{
    wr_free(illusion->map);
    *illusion = (WrIllusion){ 0 };
}
