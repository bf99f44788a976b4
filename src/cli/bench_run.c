#include "base/error.h"
#include "base/memory.h"
#include "base/pool.h"
#include "base/progress.h"
#include "brush/brush.h"
#include "cli/bench.h"
#include "command/session.h"
#include "field/field.h"
#include "render/frame/frame.h"
#include "scene/scene.h"
#include "system/clock.h"

#include <math.h>

static int ascending(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

double wr_bench_median(double *values, int count)
{
    if (count == 0) return 0;
    qsort(values, (size_t)count, sizeof *values, ascending);
    return count & 1 ? values[count / 2] : 0.5 * (values[count / 2 - 1] + values[count / 2]);
}

/* State of one row during measurement. */
typedef struct Lane {
    WrPool *pool;
    WrRenderer *renderer;
    WrScene *scene;
    WrField *field; /* shared by the rows of one table size */
    double *ms;     /* [runs] */
} Lane;

static bool lane_init(const WrCli *cli, const WrBenchRow *row, int runs, bool fast, WrField *field,
                      Lane *lane, WrError *err)
{
    lane->field = wr_field_share(field);
    lane->ms = wr_alloc((size_t)runs, sizeof *lane->ms);
    lane->pool = wr_pool_new(row->threads);
    lane->renderer = wr_renderer_new(lane->pool, cli->isa, err);
    lane->scene = lane->renderer ? wr_bench_scene(row->surface, row->mode, fast, err) : NULL;
    return lane->scene;
}

static void lane_fini(Lane *lane)
{
    wr_renderer_free(lane->renderer);
    wr_pool_free(lane->pool);
    wr_scene_free(lane->scene);
    wr_field_free(lane->field);
    wr_free(lane->ms);
}

/* Tables of the sizes that rows use, each generated once. */
static WrField *field_of(WrField **fields, const WrBenchRow *rows, int index, WrError *err)
{
    for (int i = 0; i < index; i++)
        if (rows[i].table == rows[index].table) return wr_field_share(fields[i]);
    return wr_bench_field(rows[index].table > 0 ? rows[index].table : 64, err);
}

bool wr_bench_run(const WrCli *cli, WrBenchRow *rows, int count, int runs, bool fast, WrError *err)
{
    Lane *lanes = wr_alloc((size_t)count, sizeof *lanes);
    WrField **fields = wr_alloc((size_t)count, sizeof *fields);
    bool good = true;
    for (int i = 0; i < count && good; i++) {
        fields[i] = field_of(fields, rows, i, err);
        good = fields[i] && lane_init(cli, &rows[i], runs, fast, fields[i], &lanes[i], err);
    }
    for (int run = -1; run < runs && good; run++) /* the first round fills caches and is not
                                                     counted */
        for (int i = 0; i < count && good; i++) {
            WrFrame frame;
            WrFrameRequest request = { .field = lanes[i].field,
                                       .scene = lanes[i].scene,
                                       .width = rows[i].size,
                                       .height = rows[i].size,
                                       .turn_deg = 7.3 * run,
                                       .codes = { .wanted = true } }; /* 8-bit, as displayed */
            good = wr_renderer_frame(lanes[i].renderer, &request, &frame, err);
            if (good && run >= 0) lanes[i].ms[run] = frame.times.total * 1e3;
            if (good) rows[i].covered = frame.covered;
        }
    for (int i = 0; i < count; i++) {
        if (good) rows[i].ms = wr_bench_median(lanes[i].ms, runs);
        lane_fini(&lanes[i]);
        wr_field_free(fields[i]);
    }
    wr_free(fields);
    wr_free(lanes);
    return good;
}

bool wr_bench_stroke(const WrCli *cli, WrBenchStroke *stroke, int samples, WrError *err)
{
    WrSession *session = wr_cli_session(cli, false, err);
    double *apply = wr_alloc((size_t)samples, sizeof *apply);
    double *preview = wr_alloc((size_t)samples, sizeof *preview);
    char line[64];
    WrFrame frame;
    snprintf(line, sizeof line, "table %dx%d", stroke->table, stroke->table);
    bool good = session && wr_session_run(session, "dials aa=point", err) &&
                wr_session_run(session, line, err) &&
                wr_session_run(session, "surface sphere", err) &&
                wr_session_run(session, "dials arithmetic=fast", err) &&
                wr_session_run(session, "dab 0.2,0.2 radius=40", err) &&
                wr_session_frame(session, 512, 512, 0, &frame, err) &&
                wr_session_stroke_begin(session, "stroke radius=32 strength=0.1", err);
    stroke->apply_worst_ms = 0;
    for (int i = 0; i < samples && good; i++) {
        /* A scribble in circles: about 10 texels per sample. */
        double t = 10.0 * i / stroke->table;
        WrSample sample = { .u = 0.5 + 0.3 * sin(3 * t),
                            .v = 0.5 + 0.3 * cos(2 * t),
                            .pressure = 1 };
        double start = wr_clock_seconds();
        good = wr_session_stroke_add(session, &sample, 1, err);
        double applied = wr_clock_seconds();
        good = good && wr_session_frame(session, 512, 512, 0, &frame, err);
        apply[i] = 1e3 * (applied - start);
        preview[i] = 1e3 * (wr_clock_seconds() - applied);
        stroke->apply_worst_ms = fmax(stroke->apply_worst_ms, apply[i]);
        if (wr_cancel_asked(cli->cancel)) good = wr_fail(err, "interrupted");
    }
    if (good) {
        stroke->apply_ms = wr_bench_median(apply, samples);
        stroke->preview_ms = wr_bench_median(preview, samples);
        good = wr_session_stroke_end(session, err);
    }
    wr_free(apply);
    wr_free(preview);
    wr_session_free(session);
    return good;
}
