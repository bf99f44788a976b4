#include "base/pool.h"
#include "render/frame.h"
#include "render/srgb_codes.h"

#include <math.h>

/* Linear light cut into BINS: the code of a bin's lower end, and the code's own border, give the right
   code of any value: nowhere does the curve rise by more than one code in a bin (12.92 * 255 / 4096). */
#define BINS 4096

typedef struct ResolveJob {
    const WrFrame *frame;
    float background[3];
    bool bgra;
    uint8_t *out;
    int64_t bad; /* atomic */
    uint8_t bins[BINS + 1];
} ResolveJob;

static void fill_bins(uint8_t bins[BINS + 1])
{
    int code = 0;
    for (int i = 0; i <= BINS; i++) {
        while (code < 255 && (float)i / BINS >= wr_srgb_borders[code + 1]) code++;
        bins[i] = (uint8_t)code;
    }
}

static uint8_t code_of(const ResolveJob *job, float x)
{
    x = x > 0.0f ? x : 0.0f;
    x = x < 1.0f ? x : 1.0f;
    int code = job->bins[(int)(x * BINS)];
    return (uint8_t)(code + (code < 255 && x >= wr_srgb_borders[code < 255 ? code + 1 : 255]));
}

static void resolve_row(int y, int worker, void *ctx)
{
    (void)worker;
    ResolveJob *job = ctx;
    const int width = job->frame->width, channels = job->bgra ? 4 : 3;
    const float *in = job->frame->rgba + (size_t)y * (size_t)width * 4;
    uint8_t *out = job->out + (size_t)y * (size_t)width * (size_t)channels;
    uint8_t backdrop[3];
    int64_t bad = 0;
    for (int c = 0; c < 3; c++) backdrop[c] = code_of(job, job->background[c]);
    for (int x = 0; x < width; x++, in += 4, out += channels) {
        float a = in[3];
        for (int c = 0; c < 3; c++) {
            float light = in[c] + (1.0f - a) * job->background[c];
            if (!isfinite(light)) light = 0.0f, bad++;
            uint8_t code = a == 0.0f ? backdrop[c] : code_of(job, light);
            out[job->bgra ? 2 - c : c] = code;
        }
        if (job->bgra) out[3] = 255;
    }
    if (bad) __atomic_fetch_add(&job->bad, bad, __ATOMIC_RELAXED);
}

int64_t wr_frame_to_srgb8(const WrFrame *frame, const double background[3], bool bgra, uint8_t *out,
                          WrPool *pool)
{
    ResolveJob job = { .frame = frame, .bgra = bgra, .out = out };
    for (int c = 0; c < 3; c++) job.background[c] = (float)background[c];
    fill_bins(job.bins);
    wr_pool_run(pool, frame->height, resolve_row, &job);
    return job.bad;
}
