#include "cli/brush_sample.h"

#include "base/error.h"
#include "base/exactmath.h"
#include "base/memory.h"
#include "command/session.h"
#include "document/document.h"
#include "field/field.h"
#include "render/frame/frame.h"
#include "scene/scene.h"

#include <math.h>
#include <string.h>

#define WR_SAMPLE_POINTS 96
#define WR_SAMPLE_SECONDS 1.2
#define WR_SAMPLE_RELIEF 14.0 /* texels from lowest to highest, unless that is too steep */
/* upper limit for the slope of the steepest tenth of the texels that are not flat */
#define WR_SAMPLE_STEEP 1.5

struct WrSampler {
    WrPool *pool; /* borrowed */
    int width, height;
    WrScene *scene;
    WrRenderer *renderer;
    WrField *ridges; /* table for brushes that act on existing heights */
};

/* ---- the table ---- */

/* A small table: allocation fails only if the whole program is out of memory. */
static WrField *new_table(void)
{
    return wr_field_new(WR_SAMPLE_W, WR_SAMPLE_H, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, 0, NULL);
}

/* Vertical ridges with grain: texture to smooth, sharpen and level, and straight lines that show dragging. */
static WrField *make_ridges(void)
{
    WrField *field = new_table();
    for (int j = 0; j < WR_SAMPLE_H; j++) {
        float row[WR_SAMPLE_W];
        for (int i = 0; i < WR_SAMPLE_W; i++) {
            double sine, cosine;
            wr_sincos_turns(i * 11.0 / WR_SAMPLE_W, &sine, &cosine);
            uint32_t grain = wr_mix32((uint32_t)(j / 3 * WR_SAMPLE_W + i / 3) + 1u);
            row[i] = (float)(0.04 * sine + 0.02 * (grain >> 8) * 0x1p-24);
        }
        wr_field_write(field, 0, j, WR_SAMPLE_W, 1, row, WR_SAMPLE_W);
    }
    return field;
}

static bool needs_ground(const WrPreset *preset, const WrBrush *brush)
{
    /* modes with a strength create relief on a flat table */
    return !(wr_brush_modes[brush->mode].uses & WR_USES_STRENGTH) || wr_preset_smudges(preset);
}

/* The preset's brush with its size limited to the sample. */
static WrBrush sample_brush(const WrPreset *preset)
{
    WrBrush brush = wr_preset_brush(preset);
    double least = brush.tip ? 18 : 5, most = brush.tip ? 26 : 22;
    if (brush.radius < least) brush.radius = least;
    if (brush.radius > most) brush.radius = most;
    if (brush.mode == WR_BRUSH_CLONE && brush.source_u == 0 && brush.source_v == 0)
        brush.source_u = 0.05;
    brush.seed = 1;
    return brush;
}

static WrSample sample_at(int k)
{
    double t = (double)k / (WR_SAMPLE_POINTS - 1), sine, cosine;
    wr_sincos_turns(t, &sine, &cosine);
    double pressure = t < 0.75 ? 0.12 + 0.88 * t / 0.75 : 1.0 - 0.7 * (t - 0.75) / 0.25;
    return (WrSample){ .u = 0.14 + 0.72 * t,
                       .v = 0.5 + 0.2 * sine,
                       .pressure = pressure,
                       .tilt_x = -0.6 + 1.2 * t,
                       .tilt_y = 0.3,
                       .seconds = WR_SAMPLE_SECONDS * t };
}

static WrField *paint(WrSampler *sampler, const WrPreset *preset)
{
    WrBrush brush = sample_brush(preset);
    WrField *field = needs_ground(preset, &brush) ? wr_field_share(sampler->ridges) : new_table();
    WrBrushGround ground = { .field = field, .pool = sampler->pool };
    WrStroke *stroke = wr_stroke_new_on(&ground, &brush);
    for (int k = 0; k < WR_SAMPLE_POINTS; k++) wr_stroke_add(stroke, sample_at(k));
    wr_stroke_free(stroke);
    return field;
}

/* ---- the light ---- */

static int compare_floats(const void *a, const void *b)
{
    float x = *(const float *)a, y = *(const float *)b;
    return (x > y) - (x < y);
}

/* Scale from heights to scene units, with the table one unit high: from WR_SAMPLE_RELIEF, or lower if that were too
 * steep. */
static double show_height(const WrField *field)
{
    enum { W = WR_SAMPLE_W, H = WR_SAMPLE_H };
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
        double by_range = WR_SAMPLE_RELIEF / ((double)high - (double)low);
        double by_slope = WR_SAMPLE_STEEP / steep;
        height = (by_range < by_slope ? by_range : by_slope) / H;
    }
    wr_free(values);
    wr_free(slopes);
    return isfinite(height) ? height : 0;
}

/* A plane with the picture's width and height, lit from the upper left with a weak light from the other side. */
static WrScene *make_scene(const WrCli *cli, WrError *err)
{
    static const char *const lines[] = {
        "surface plane a=1.3333333333333333 b=1",
        "bump mode=exact scheme=bspline height=1",
        "camera orthographic size=0.996",
        "material ambient=0.05 diffuse=0.95 specular=0.2 shininess=30 colour=0.8,0.8,0.8",
        "light directional to=-1,1,0.8 strength=0.95",
        "light directional to=1,-0.4,0.9 strength=0.22",
        "dials aa=supersample samples=3",
    };
    WrSession *session = wr_cli_session(cli, false, err);
    bool good = session;
    for (size_t i = 0; good && i < sizeof lines / sizeof *lines; i++)
        good = wr_session_run(session, lines[i], err);
    WrScene *scene = good ? wr_scene_clone(wr_session_document(session)->scene) : NULL;
    wr_session_free(session);
    return scene;
}

/* ---- the sampler ---- */

WrSampler *wr_sampler_new(const WrCli *cli, int width, int height, WrError *err)
{
    WrSampler *sampler = wr_alloc(1, sizeof *sampler);
    sampler->pool = cli->pool;
    sampler->width = width;
    sampler->height = height;
    sampler->ridges = make_ridges();
    sampler->scene = make_scene(cli, err);
    if (sampler->scene) sampler->renderer = wr_renderer_new(cli->pool, cli->isa, err);
    if (sampler->renderer) return sampler;
    wr_sampler_free(sampler);
    return NULL;
}

void wr_sampler_free(WrSampler *sampler)
{
    if (!sampler) return;
    wr_renderer_free(sampler->renderer);
    wr_scene_free(sampler->scene);
    wr_field_free(sampler->ridges);
    wr_free(sampler);
}

bool wr_sampler_paint(WrSampler *sampler, const WrPreset *preset, uint8_t *grey, WrError *err)
{
    WrFrame frame;
    WrField *field = paint(sampler, preset);
    sampler->scene->height = show_height(field);
    WrFrameRequest request = {
        .field = field, .scene = sampler->scene, .width = sampler->width, .height = sampler->height
    };
    request.codes = wr_frame_codes_of(sampler->scene, true);
    bool good = wr_renderer_frame(sampler->renderer, &request, &frame, err);
    if (good) {
        size_t count = (size_t)sampler->width * (size_t)sampler->height;
        for (size_t i = 0; i < count; i++) grey[i] = (uint8_t)(frame.codes[i] >> 16);
    }
    wr_field_free(field);
    return good;
}
