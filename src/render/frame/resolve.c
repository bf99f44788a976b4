#include "base/pool.h"
#include "render/frame/pixel_encode.h"
#include "render/frame/frame.h"

#include "scene/scene.h"

#include <math.h>
#include <string.h>

/* At most one border lies in a bin. Above the last code the border is put past the bin's end. */
void wr_code_bins_fill(uint32_t bins[WR_CODE_BINS + 1])
{
    uint32_t code = 0;
    for (int i = 0; i <= WR_CODE_BINS; i++) {
        while (code < 255 && (float)i / WR_CODE_BINS >= wr_srgb_borders[code + 1]) code++;
        const float next = code < 255 ? wr_srgb_borders[code + 1] * WR_CODE_BINS - (float)i : 1.0f;
        bins[i] = code | (uint32_t)(fminf(next, 1.0f) * WR_CODE_STEPS) << 8;
    }
}

typedef struct ResolveJob {
    const WrFrame *frame;
    WrPixelEncoder coder;
    WrBackdrop backdrop;
    bool bgra;
    uint8_t *out;
    int64_t not_finite; /* atomic */
    uint32_t bins[WR_CODE_BINS + 1];
} ResolveJob;

/* Un-premultiplied, opaque colours.
   The alpha of 8-bit files is not premultiplied (PNG). Dividing in linear light, before encoding, is exact up
   to rounding. */
static void part_from_alpha(const float *from, int count, float to[WR_SPAN][4])
{
    for (int i = 0; i < count; i++) {
        const float alpha = from[4 * i + 3];
        for (int c = 0; c < 3; c++) to[i][c] = alpha > 0.0f ? from[4 * i + c] / alpha : 0.0f;
        to[i][3] = 1.0f;
    }
}

static uint8_t alpha_code(float alpha)
{
    return (uint8_t)(255.0f * (alpha > 0.0f ? alpha < 1.0f ? alpha : 1.0f : 0.0f) + 0.5f);
}

/* Writes a row as R,G,B,A. */
static void alpha_row(int y, int worker, void *ctx)
{
    (void)worker;
    ResolveJob *job = ctx;
    const WrBehind behind = { 0 };
    const int width = job->frame->width;
    const float *in = job->frame->rgba + (size_t)y * (size_t)width * 4;
    uint8_t *out = job->out + (size_t)y * (size_t)width * 4;
    int64_t not_finite = 0;
    for (int x = 0; x < width; x += WR_SPAN) {
        uint32_t codes[WR_SPAN];
        float own[WR_SPAN][4];
        const int count = width - x < WR_SPAN ? width - x : WR_SPAN;
        part_from_alpha(in + 4 * (size_t)x, count, own);
        not_finite += wr_code_row(&job->coder, &behind, 0, count, own[0], codes);
        for (int i = 0; i < count; i++) {
            uint8_t *to = out + 4 * (size_t)(x + i);
            wr_codes_to_rgb(codes + i, 1, to);
            to[3] = alpha_code(in[4 * (x + i) + 3]);
        }
    }
    if (not_finite) __atomic_fetch_add(&job->not_finite, not_finite, __ATOMIC_RELAXED);
}

/* Colours are premultiplied and the background is opaque: codes_over adds (1 - alpha) of it, and no alpha is left. */
static void resolve_row(int y, int worker, void *ctx)
{
    (void)worker;
    ResolveJob *job = ctx;
    const int width = job->frame->width, channels = job->bgra ? 4 : 3;
    const float *in = job->frame->rgba + (size_t)y * (size_t)width * 4;
    uint8_t *out = job->out + (size_t)y * (size_t)width * (size_t)channels;
    int64_t not_finite = 0;
    for (int x = 0; x < width; x += WR_SPAN) {
        uint32_t codes[WR_SPAN];
        const int count = width - x < WR_SPAN ? width - x : WR_SPAN;
        not_finite += wr_code_row(&job->coder, wr_backdrop_at(&job->backdrop, x, y),
                                  job->backdrop.across, count, in + 4 * (size_t)x, codes);
        if (job->bgra) memcpy(out + 4 * (size_t)x, codes, (size_t)count * sizeof *codes);
        else wr_codes_to_rgb(codes, (size_t)count, out + 3 * (size_t)x);
    }
    if (not_finite) __atomic_fetch_add(&job->not_finite, not_finite, __ATOMIC_RELAXED);
}

void wr_codes_to_rgb(const uint32_t *codes, size_t count, uint8_t *out)
{
    for (size_t i = 0; i < count; i++) {
        out[3 * i] = (uint8_t)(codes[i] >> 16);
        out[3 * i + 1] = (uint8_t)(codes[i] >> 8);
        out[3 * i + 2] = (uint8_t)codes[i];
    }
}

static WrPixelEncoder coder_of(ResolveJob *job, const WrTone *tone)
{
    wr_code_bins_fill(job->bins);
    return (WrPixelEncoder){ wr_kernels_get(NULL, false, NULL), job->bins,
                             wr_tone_curve_params(tone) };
}

WrFrameCodes wr_frame_codes_of(const WrScene *scene, bool wanted)
{
    return (WrFrameCodes){ wanted, scene->background, scene->tone, scene };
}

int64_t wr_frame_to_srgb8(const WrFrame *frame, const WrFrameCodes *how, bool bgra, uint8_t *out,
                          WrPool *pool)
{
    ResolveJob job = { .frame = frame, .bgra = bgra, .out = out };
    job.coder = coder_of(&job, &how->tone);
    wr_backdrop_update(&job.backdrop, how, 0, frame->width, frame->of, frame->first, frame->height,
                       &job.coder, pool);
    wr_pool_run(pool, frame->height, resolve_row, &job);
    wr_backdrop_fini(&job.backdrop);
    return job.not_finite;
}

int64_t wr_frame_to_alpha8(const WrFrame *frame, const WrTone *tone, uint8_t *out, WrPool *pool)
{
    ResolveJob job = { .frame = frame, .out = out };
    job.coder = coder_of(&job, tone);
    wr_pool_run(pool, frame->height, alpha_row, &job);
    return job.not_finite;
}
