/* Dab benchmark: our round brush and engine, compared with libmypaint's own surface with the same brush and
   motion. */
#include "base/error.h"
#include "base/memory.h"
#include "base/progress.h"
#include "base/text.h"
#include "brush/brush.h"
#include "brush/bench_libmypaint.h"
#include "cli/bench.h"
#include "field/field.h"
#include "system/clock.h"

#include <math.h>

#define ROUNDS_MAX 15

static double rate(double dabs, double seconds)
{
    return seconds > 0 ? dabs / seconds : 0;
}

static bool bench_brush(const WrCli *cli, WrBenchBrush *brush, int dabs, int rounds, WrError *err)
{
    WrBrushPace pace;
    if (!wr_brush_pace(brush->table, brush->radius, dabs, &pace, err)) return false;
    WrBrushRace *race = wr_brush_race_new(&pace, err);
    if (!race) return false;
    rounds = rounds < ROUNDS_MAX ? rounds : ROUNDS_MAX;
    double times[3][ROUNDS_MAX];
    bool good = true;
    for (int k = -1; k < rounds && good;
         k++) { /* the first run warms the memory and is not counted */
        double seconds[] = { wr_brush_race_peer(race), wr_brush_race_engine(race),
                             wr_brush_race_round(race) };
        for (int n = 0; n < 3 && k >= 0; n++) times[n][k] = seconds[n];
        if (wr_cancel_asked(cli->cancel)) good = wr_fail(err, "interrupted");
    }
    wr_brush_race_free(race);
    if (!good) return false;
    brush->peer = rate(pace.peer_dabs, wr_bench_median(times[0], rounds));
    brush->engine = rate(pace.engine_dabs, wr_bench_median(times[1], rounds));
    brush->round = rate(pace.round_dabs, wr_bench_median(times[2], rounds));
    return true;
}

static const WrBenchBrush sizes[] = { { .radius = 4 }, { .radius = 32 }, { .radius = 256 } };
static const int dab_counts[] = { 60000, 6000, 300 };

/* 'brush radius who table threads ms', ms of one dab. */
bool wr_bench_brush_lines(const WrCli *cli, bool quick, WrText *text, WrError *err)
{
    for (int i = 0; i < 3; i++) {
        WrBenchBrush b = sizes[i];
        b.table = 4096;
        if (!bench_brush(cli, &b, dab_counts[i], quick ? 3 : 9, err)) return false;
        const double rates[] = { b.peer, b.engine, b.round };
        static const char *const names[] = { "libmypaint", "engine", "round" };
        for (int n = 0; n < 3; n++)
            wr_text_addf(text, "brush %g %s %d 1 %.6f\n", b.radius, names[n], b.table,
                         rates[n] > 0 ? 1e3 / rates[n] : 0);
    }
    return true;
}

/* Nanoseconds of one round dab; all dabs hit the same few tiles in the table's middle. */
static double time_dab(WrField *field)
{
    enum { DABS = 4000 };
    double side = wr_field_width(field), start = wr_clock_seconds();
    WrBrush brush = wr_brush_default();
    brush.radius = 32.0;
    for (int i = 0; i < DABS; i++)
        wr_brush_dab(field, &brush, 0.5 + i * 16 % 200 / side, 0.5 + i * 7 % 150 / side);
    return 1e9 * (wr_clock_seconds() - start) / DABS;
}

/* The same dabs on a small and on a large table, alternating. */
static bool add_sizes(bool quick, WrText *text, WrError *err)
{
    static const int sides[2] = { 512, 16384 };
    WrField *fields[2] = { NULL, NULL };
    double times[2][ROUNDS_MAX], median[2];
    int rounds = quick ? 5 : ROUNDS_MAX;
    bool good = true;
    for (int t = 0; t < 2 && good; t++) {
        fields[t] = wr_field_new(sides[t], sides[t], WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, 0.0f, err);
        good = fields[t] != NULL;
    }
    for (int k = -1; k < rounds && good; k++)
        for (int t = 0; t < 2; t++) {
            double ns = time_dab(fields[t]);
            if (k >= 0) times[t][k] = ns;
        }
    for (int t = 0; t < 2 && good; t++) median[t] = wr_bench_median(times[t], rounds);
    if (good)
        wr_text_addf(text,
                     "  a dab of radius 32 takes %.0f ns on a table of %dx%d, %.0f on %dx%d: %.2f "
                     "times as long\n",
                     median[0], sides[0], sides[0], median[1], sides[1], sides[1],
                     median[1] / median[0]);
    for (int t = 0; t < 2; t++) wr_field_free(fields[t]);
    return good;
}

bool wr_bench_brush_table(const WrCli *cli, bool quick, WrText *text, WrError *err)
{
    wr_text_addf(text, "\ndabs a second         %12s %8s %12s %8s %6s %12s %8s %6s\n", "libmypaint",
                 "Mpixel/s", "its engine", "Mpixel/s", "ratio", "round", "Mpixel/s", "ratio");
    for (int i = 0; i < 3; i++) {
        WrBenchBrush b = sizes[i];
        b.table = 4096;
        if (!bench_brush(cli, &b, dab_counts[i], quick ? 3 : 9, err)) return false;
        double mega = 3.14159265358979 * b.radius * b.radius * 1e-6;
        wr_text_addf(text, "  radius %-12g %12.0f %8.0f %12.0f %8.0f %6.2f %12.0f %8.0f %6.2f\n",
                     b.radius, b.peer, b.peer * mega, b.engine, b.engine * mega, b.engine / b.peer,
                     b.round, b.round * mega, b.round / b.peer);
    }
    return add_sizes(quick, text, err);
}
