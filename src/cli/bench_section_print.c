/* Sections and peaks as tables and as JSON. */
#include "base/pool.h"
#include "base/text.h"
#include "cli/bench.h"
#include "cli/bench_sections.h"
#include "cli/cli.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* Rates of a picture besides its time; NAN: none. */
typedef struct Rates {
    double ratio, ns, gbytes, gflops;
} Rates;

static double over(double a, double b)
{
    return a > 0 && b > 0 ? a / b : NAN;
}

static Rates rates_of(const WrBenchSections *all, const WrBenchPicture *p)
{
    return (Rates){ .ratio = over(p->ms, all->picture[p->base].ms),
                    .ns = over(1e6 * p->ms, (double)p->samples),
                    .gbytes = over(1e-6 * p->bytes, p->ms),
                    .gflops = over(1e-6 * p->flops * (double)p->samples, p->ms) };
}

static int threads_of(const WrBenchSections *all)
{
    return wr_pool_threads(all->cli->pool);
}

void wr_bench_peaks_print(const WrBenchSections *all, WrText *text)
{
    wr_text_addf(text, "picture %dx%d, %s arithmetic, threads %d, medians of %d rounds by turns\n",
                 all->width, all->height, all->fast ? "fast" : "exact", threads_of(all),
                 all->rounds);
    wr_text_add(text, "this machine at its best:");
    for (int b = 0; b < WR_PEAK_BUILDS; b++)
        if (all->peaks.gflops[b] > 0)
            wr_text_addf(text, " %s %.1f", wr_peak_builds[b], all->peaks.gflops[b]);
    wr_text_add(text, " GFLOP/s; copying");
    for (int k = 0; k < WR_PEAK_LEVELS; k++)
        wr_text_addf(text, " %s %.1f", wr_peak_levels[k], all->peaks.gbytes[k]);
    wr_text_add(text, " GB/s\n");
}

static void add_rate(WrText *text, int width, int digits, double x)
{
    if (isnan(x)) wr_text_addf(text, " %*s", width, "-");
    else wr_text_addf(text, " %*.*f", width, digits, x);
}

void wr_bench_section_print(const WrBenchSections *all, WrText *text)
{
    wr_text_addf(text, "\n%s: %s\n%-38s %9s %9s %7s %10s %7s %8s\n", all->section->name,
                 all->section->varies, "", "ms", "least", "ratio", "ns/sample", "GB/s", "GFLOP/s");
    for (int i = 0; i < all->count; i++) {
        const WrBenchPicture *p = &all->picture[i];
        const Rates r = rates_of(all, p);
        wr_text_addf(text, "  %-36s %9.3f %9.3f", p->name, p->ms, p->least_ms);
        add_rate(text, 7, 2, r.ratio);
        add_rate(text, 10, 2, r.ns);
        add_rate(text, 7, 2, r.gbytes);
        add_rate(text, 8, 2, r.gflops);
        wr_text_add(text, "\n");
    }
}

static void member(WrText *text, const char *name, double x)
{
    wr_text_addf(text, ", \"%s\": ", name);
    wr_text_add_json_number(text, x);
}

static void string_member(WrText *text, const char *name, const char *value)
{
    wr_text_addf(text, ", \"%s\": ", name);
    wr_text_add_json_string(text, value);
}

void wr_bench_head_json(const WrBenchSections *all, WrText *text)
{
    wr_text_addf(text, "\"width\": %d, \"height\": %d, \"threads\": %d, \"rounds\": %d", all->width,
                 all->height, threads_of(all), all->rounds);
    string_member(text, "isa", all->cli->isa ? all->cli->isa : "auto");
    string_member(text, "arithmetic", all->fast ? "fast" : "exact");
    wr_text_add(text, ",\n\"peaks\": {\"sums\": [");
    const char *comma = "";
    for (int b = 0; b < WR_PEAK_BUILDS; b++) {
        if (!(all->peaks.gflops[b] > 0)) continue;
        wr_text_addf(text, "%s{\"isa\": \"%s\"", comma, wr_peak_builds[b]);
        member(text, "gflops", all->peaks.gflops[b]);
        wr_text_add(text, "}");
        comma = ", ";
    }
    wr_text_add(text, "], \"copies\": [");
    for (int k = 0; k < WR_PEAK_LEVELS; k++) {
        wr_text_addf(text, "%s{\"level\": \"%s\"", k > 0 ? ", " : "", wr_peak_levels[k]);
        member(text, "bytes", all->peaks.bytes[k]);
        member(text, "gbytes", all->peaks.gbytes[k]);
        wr_text_add(text, "}");
    }
    wr_text_add(text, "]}");
}

static void row_json(const WrBenchSections *all, const WrBenchPicture *p, WrText *text)
{
    const Rates r = rates_of(all, p);
    wr_text_add(text, "  {\"name\": ");
    wr_text_add_json_string(text, p->name);
    string_member(text, "base", all->picture[p->base].name);
    member(text, "table", p->table);
    member(text, "ms", p->ms);
    member(text, "least_ms", p->least_ms);
    member(text, "ratio", r.ratio);
    member(text, "samples", (double)p->samples);
    member(text, "ns_per_sample", r.ns);
    member(text, "bytes", p->bytes > 0 ? p->bytes : NAN);
    member(text, "gbytes", r.gbytes);
    member(text, "flops_per_sample", p->flops > 0 ? p->flops : NAN);
    member(text, "gflops", r.gflops);
    if (p->effect >= 0) {
        string_member(text, "effect", wr_effects[p->effect].rule);
        wr_text_addf(text, ", \"ran\": %s", p->ran ? "true" : "false");
    }
    wr_text_add(text, "}");
}

void wr_bench_section_json(const WrBenchSections *all, WrText *text)
{
    wr_text_addf(text, "{\"name\": \"%s\"", all->section->name);
    string_member(text, "varies", all->section->varies);
    wr_text_add(text, ", \"rows\": [\n");
    for (int i = 0; i < all->count; i++) {
        row_json(all, &all->picture[i], text);
        wr_text_add(text, i + 1 < all->count ? ",\n" : "]}");
    }
}

void wr_bench_lines_json(const char *lines, WrText *text)
{
    char word[6][32];
    const char *comma = "", *end;
    wr_text_add(text, "[");
    for (const char *line = lines; (end = strchr(line, '\n')); line = end + 1) {
        if (sscanf(line, "%31s %31s %31s %31s %31s %31s", word[0], word[1], word[2], word[3],
                   word[4], word[5]) != 6)
            continue;
        wr_text_addf(text,
                     "%s\n  {\"what\": \"%s\", \"of\": \"%s\", \"how\": \"%s\", \"table\": %s, "
                     "\"threads\": %s, \"ms\": %s}",
                     comma, word[0], word[1], word[2], word[3], word[4], word[5]);
        comma = ",";
    }
    wr_text_add(text, "]");
}
