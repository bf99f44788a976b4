#include "render/frame.h"

#include <math.h>

/* sRGB codes of equal steps of linear light: fine enough that the code is right to rounding but where
   a value falls within 1e-4 of a code's border. */
#define TABLE 16384

typedef struct ResolveJob {
    const WrFrame *frame;
    float background[3];
    bool bgra;
    uint8_t *out;
    int64_t bad; /* atomic */
    uint8_t table[TABLE + 2];
} ResolveJob;

static uint8_t code_of(const ResolveJob *job, float x)
{
    x = x > 0.0f ? x : 0.0f;
    x = x < 1.0f ? x : 1.0f;
    if (x < 0.05f)
        return (uint8_t)(wr_srgb_encode(x) * 255.0f + 0.5f); /* the curve is steep here */
    return job->table[(int)(x * TABLE + 0.5f)];
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
    for (int i = 0; i <= TABLE; i++)
        job.table[i] = (uint8_t)(wr_srgb_encode((float)i / TABLE) * 255.0f + 0.5f);
    job.table[TABLE + 1] = 255;
    wr_pool_run(pool, frame->height, resolve_row, &job);
    return job.bad;
}
