#include "command/brush_sample.h"

#include "base/error.h"
#include "base/exactmath.h"
#include "base/memory.h"
#include "brush/brush.h"
#include "brush/preset.h"
#include "command/session.h"
#include "document/document.h"
#include "field/field.h"
#include "render/frame/frame.h"
#include "scene/scene.h"

#include <math.h>
#include <stdlib.h>

enum { W = 256, H = 192 }; /* texels of the table */

#define POINTS 96
#define SECONDS 1.2
#define RELIEF 22.0 /* texels from lowest to highest, unless that is too steep */
/* upper limit for the slope of the steepest tenth of the texels that are not flat */
#define STEEP 1.7
#define STUD 32     /* texels from stud to stud */
#define STUD_UP 0.1 /* height of a stud */
#define PASSES 3    /* strokes over the studs, so that gentle brushes show too */

struct WrBrushSample {
    WrSession *session; /* owns the scene's lights and the renderer */
    WrScene *scene;
    WrRenderer *renderer;
    int width, height;
};

/* ---- the table ---- */

/* Squares with a level top and bevelled sides on rough ground: edges to smooth, sharpen, drag and wear. */
static void fill_studs(WrField *field)
{
    for (int j = 0; j < H; j++) {
        float row[W];
        for (int i = 0; i < W; i++) {
            int x = abs(i % STUD - STUD / 2), y = abs(j % STUD - STUD / 2);
            double side = (STUD / 2 - 2 - (x > y ? x : y)) / 5.0;
            double up = side < 0 ? 0 : side > 1 ? 1 : side;
            uint32_t grain = wr_mix32((uint32_t)(j / 3 * W + i / 3) + 1u);
            row[i] = (float)(STUD_UP * up + 0.015 * (grain >> 8) * 0x1p-24);
        }
        wr_field_write(field, 0, j, W, 1, row, W);
    }
}

/* Modes with a strength create relief on a flat table; others change existing heights. */
static bool needs_ground(const WrPreset *preset, const WrBrush *brush)
{
    return !(wr_brush_modes[brush->mode].uses & WR_USES_STRENGTH) ||
           wr_brush_modes[brush->mode].moves || (preset && wr_preset_smudges(preset));
}

/* The preset's brush with its size limited to the sample. */
static WrBrush sample_brush(const WrPreset *preset)
{
    WrBrush brush = preset ? wr_preset_brush(preset) : wr_brush_default();
    bool ground = needs_ground(preset, &brush);
    double least = brush.tip ? 24 : ground ? 26 : 6, most = brush.tip ? 34 : 30;
    if (brush.radius < least) brush.radius = least;
    if (brush.radius > most) brush.radius = most;
    if (brush.mode == WR_BRUSH_CLONE && brush.source_u == 0 && brush.source_v == 0)
        brush.source_u = 0.05;
    brush.seed = 1;
    return brush;
}

static WrSample sample_at(int k)
{
    double t = (double)k / (POINTS - 1), sine, cosine;
    wr_sincos_turns(t, &sine, &cosine);
    double pressure = t < 0.75 ? 0.12 + 0.88 * t / 0.75 : 1.0 - 0.7 * (t - 0.75) / 0.25;
    return (WrSample){ .u = 0.16 + 0.68 * t,
                       .v = 0.5 + 0.25 * sine,
                       .pressure = pressure,
                       .tilt_x = -0.6 + 1.2 * t,
                       .tilt_y = 0.3,
                       .seconds = SECONDS * t };
}

static WrField *paint(const WrPreset *preset, WrError *err)
{
    WrBrush brush = sample_brush(preset);
    WrField *field = wr_field_new(W, H, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, 0, err);
    if (!field) return NULL;
    bool ground = needs_ground(preset, &brush);
    if (ground) fill_studs(field);
    for (int pass = 0; pass < (ground ? PASSES : 1); pass++) {
        WrStroke *stroke = wr_stroke_new(field, &brush);
        for (int k = 0; k < POINTS; k++) wr_stroke_add(stroke, sample_at(k));
        wr_stroke_finish(stroke);
    }
    return field;
}

/* ---- the light ---- */

static int compare_floats(const void *a, const void *b)
{
    float x = *(const float *)a, y = *(const float *)b;
    return (x > y) - (x < y);
}

/* Scale from heights to scene units, with the table one unit high: from RELIEF, or lower if that were too
 * steep. */
static double show_height(const WrField *field)
{
    float *values = wr_alloc((size_t)W * H, sizeof *values);
    float *slopes = wr_alloc((size_t)W * H, sizeof *slopes);
    float low, high, steepest = 0;
    int count = 0;
    wr_field_range(field, &low, &high);
    wr_field_read(field, 0, 0, W, H, values, W);
    for (int j = 0; j < H; j++)
        for (int i = 0; i < W; i++) {
            float du = values[j * W + (i + 1) % W] - values[j * W + (i + W - 1) % W];
            float dv = values[(j + 1) % H * W + i] - values[(j + H - 1) % H * W + i];
            slopes[j * W + i] = 0.5f * sqrtf(du * du + dv * dv);
            steepest = steepest < slopes[j * W + i] ? slopes[j * W + i] : steepest;
        }
    for (int k = 0; k < W * H; k++)
        if (slopes[k] > 0.05f * steepest) slopes[count++] = slopes[k];
    double height = 1;
    if (count > 0) {
        qsort(slopes, (size_t)count, sizeof *slopes, compare_floats);
        double steep = (double)slopes[count - 1 - count / 10];
        double by_range = RELIEF / ((double)high - (double)low);
        double by_slope = STEEP / steep;
        height = (by_range < by_slope ? by_range : by_slope) / H;
    }
    wr_free(values);
    wr_free(slopes);
    return isfinite(height) ? height : 0;
}

/* A plane with the table's proportions, lit from the upper left with a weak light from the other side. */
static bool light(WrBrushSample *sample, const char *isa, WrError *err)
{
    static const char *const lines[] = {
        "surface plane a=1.3333333333333333 b=1",
        "bump mode=exact scheme=bspline height=1",
        "camera orthographic size=0.996",
        "material ambient=0.03 diffuse=0.95 specular=0.25 shininess=24 colour=0.6,0.6,0.6",
        "light directional to=-1,1,0.75 strength=0.95",
        "light directional to=1,-0.4,0.9 strength=0.12",
        "dials aa=supersample samples=3",
    };
    const WrSessionOptions options = { .isa = isa };
    sample->session = wr_session_new(&options);
    bool good = sample->session;
    for (size_t i = 0; good && i < sizeof lines / sizeof *lines; i++)
        good = wr_session_run(sample->session, lines[i], err);
    return good;
}

/* ---- the sample ---- */

WrBrushSample *wr_brush_sample_new(WrPool *pool, const char *isa, int width, int height,
                                   WrError *err)
{
    WrBrushSample *sample = wr_alloc(1, sizeof *sample);
    sample->width = width;
    sample->height = height;
    if (light(sample, isa, err)) {
        sample->scene = wr_scene_clone(wr_session_document(sample->session)->scene);
        sample->renderer = wr_renderer_new(pool, isa, err);
    }
    if (sample->renderer) return sample;
    wr_brush_sample_free(sample);
    return NULL;
}

void wr_brush_sample_free(WrBrushSample *sample)
{
    if (!sample) return;
    wr_renderer_free(sample->renderer);
    wr_scene_free(sample->scene);
    wr_session_free(sample->session);
    wr_free(sample);
}

bool wr_brush_sample_paint(WrBrushSample *sample, const WrPreset *preset, uint8_t *grey,
                           WrError *err)
{
    WrFrame frame;
    WrField *field = paint(preset, err);
    if (!field) return false;
    sample->scene->height = show_height(field);
    WrFrameRequest request = {
        .field = field, .scene = sample->scene, .width = sample->width, .height = sample->height
    };
    request.codes = wr_frame_codes_of(sample->scene, true);
    bool good = wr_renderer_frame(sample->renderer, &request, &frame, err);
    size_t count = good ? (size_t)sample->width * (size_t)sample->height : 0;
    for (size_t i = 0; i < count; i++) grey[i] = (uint8_t)(frame.codes[i] >> 16);
    wr_field_free(field);
    return good;
}
