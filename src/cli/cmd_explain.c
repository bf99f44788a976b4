#include "accuracy/effect_savings.h"
#include "accuracy/tolerance.h"
#include "base/error.h"
#include "base/memory.h"
#include "base/text.h"
#include "cli/cli.h"
#include "command/layer_plan.h"
#include "command/session.h"
#include "document/document.h"
#include "image/image.h"
#include "render/frame/frame.h"
#include "render/plan/effect_heatmap.h"
#include "render/plan/plan.h"
#include "scene/dials.h"

#include <stdbool.h>
#include <stdio.h>

typedef struct WrCli WrCli;
typedef struct WrError WrError;
typedef struct WrHeatmapCounts WrHeatmapCounts;
typedef struct WrSession WrSession;
typedef struct WrText WrText;

/* ---- explain map ---- */

static bool map_check(const WrCli *cli, WrError *err)
{
    return !cli->map || wr_image_can_write(cli->map, WR_PIXEL_U8, 3, true, err);
}

/* Render the session's picture and write the effects of each pixel to cli->map. */
static bool map_write(const WrCli *cli, WrSession *session, WrHeatmapCounts *counts, WrError *err)
{
    const size_t pixels = (size_t)cli->width * (size_t)cli->height;
    uint8_t *map = wr_try_alloc(pixels, 1, "map", err), *rgb = NULL;
    bool good = map && wr_session_map(session, cli->width, cli->height, 0, map, err);
    if (good) wr_heatmap_count(map, pixels, counts);
    if (good) rgb = wr_try_alloc(pixels, 3, "map", err);
    uint8_t colours[256][3];
    if (rgb) wr_heatmap_colours(counts, colours);
    for (size_t i = 0; rgb && i < pixels; i++)
        for (int c = 0; c < 3; c++) rgb[3 * i + (size_t)c] = colours[map[i]][c];
    good = rgb &&
           wr_image_write_pixels(cli->map, cli->width, cli->height, 3, WR_PIXEL_U8, true, rgb, err);
    wr_free(map);
    wr_free(rgb);
    return good;
}

/* ---- the legend ---- */

static void map_legend(const WrHeatmapCounts *counts, WrText *text)
{
    WrHeatmapLine line;
    wr_text_addf(text, "\n%-7s %9s  %s\n", "colour", "pixels", "in the map");
    for (int i = 0; wr_heatmap_line(counts, i, &line); i++) {
        wr_text_addf(text, "#%02x%02x%02x %9lld  ", line.rgb[0], line.rgb[1], line.rgb[2],
                     (long long)line.pixels);
        wr_heatmap_colour(&line, text);
        wr_text_add(text, ": ");
        wr_heatmap_words(&line, text);
        wr_text_add(text, "\n");
    }
}

static void map_legend_json(const WrHeatmapCounts *counts, WrText *text)
{
    WrHeatmapLine line;
    for (int i = 0; wr_heatmap_line(counts, i, &line); i++) {
        wr_text_addf(text, "%s{\"colour\":\"#%02x%02x%02x\",\"what\":\"%s\",\"samples\":%d,",
                     i ? "," : "", line.rgb[0], line.rgb[1], line.rgb[2], line.what, line.samples);
        wr_text_addf(text, "\"pixels\":%lld}", (long long)line.pixels);
    }
}

/* Print {"bump":"mode=...","dials":"aa=..."} */
static void add_json_dials(WrText *text, const WrScene *scene)
{
    WrText bump = { 0 }, dials = { 0 };
    wr_dials_print(scene, "bump", true, &bump);
    wr_dials_print(scene, "dials", false, &dials);
    wr_text_add(text, "{\"bump\":");
    wr_text_add_json_string(text, wr_text_get(&bump));
    wr_text_add(text, ",\"dials\":");
    wr_text_add_json_string(text, wr_text_get(&dials));
    wr_text_add(text, "}");
    wr_text_fini(&bump);
    wr_text_fini(&dials);
}

static void add_json_choice(WrText *text, const WrChoice *choice)
{
    wr_text_addf(text, ",\"tolerance\":{\"met\":%s,\"rms\":", choice->met ? "true" : "false");
    wr_text_add_json_number(text, choice->rms);
    wr_text_add(text, ",\"max\":");
    wr_text_add_json_number(text, choice->max);
    wr_text_add(text, ",\"seconds\":");
    wr_text_add_json_number(text, choice->seconds);
    wr_text_add(text, ",\"choosing_seconds\":");
    wr_text_add_json_number(text, choice->spent);
    wr_text_add(text, ",\"reason\":");
    wr_text_add_json_string(text, choice->reason);
    wr_text_add(text, ",\"chosen\":[");
    add_json_dials(text, choice->dials);
    wr_text_add(text, "]}");
}

/* Print the costs that belong to no effect, and the sum of all. */
static void add_json_costs(WrText *text, const WrPlan *plan)
{
    wr_text_add(text, "],\"costs\":[");
    for (int i = 0; i < WR_COST_COUNT; i++) {
        wr_text_addf(text, "%s{\"name\":\"%s\",\"reason\":", i ? "," : "", wr_cost_names[i]);
        wr_text_add_json_string(text, wr_cost_reasons[i]);
        wr_text_add(text, ",\"seconds\":");
        wr_text_add_json_number(text, plan->cost[i]);
        wr_text_add(text, "}");
    }
    wr_text_add(text, "],\"work_seconds\":");
    wr_text_add_json_number(text, plan->work);
}

/* Optional parts of the output. */
typedef struct Explanation {
    const WrPlan *plan;
    const WrChoice *choice;
    const WrFrame *frame;
    const WrSaving *savings;    /* [WR_EFFECT_COUNT]; NULL: not requested */
    const WrHeatmapCounts *map; /* NULL: not requested */
} Explanation;

static void add_json_seconds(WrText *text, const char *name, bool there, double seconds)
{
    wr_text_addf(text, "\"%s\":", name);
    if (there) wr_text_add_json_number(text, seconds);
    else wr_text_add(text, "null");
    wr_text_add(text, ",");
}

/* Print ,"measured":{"costs_seconds":0.001,"saved_seconds":null, ...} or {"why_not":"..."} */
static void add_json_saving(WrText *text, const WrSaving *saving)
{
    wr_text_add(text, ",\"measured\":{");
    if (saving->why_not) {
        wr_text_add(text, "\"why_not\":");
        wr_text_add_json_string(text, saving->why_not);
        wr_text_add(text, "}");
        return;
    }
    add_json_seconds(text, "costs_seconds", saving->run, saving->seconds);
    add_json_seconds(text, "saved_seconds", !saving->run, saving->seconds);
    add_json_seconds(text, "spread_seconds", true, saving->spread);
    add_json_seconds(text, "planned_seconds", true, saving->planned);
    add_json_seconds(text, "forced_seconds", true, saving->forced);
    wr_text_addf(text, "\"within_noise\":%s,\"runs\":%d,\"tiles\":%lld,\"pixels\":%lld,\"also\":[",
                 saving->noise ? "true" : "false", saving->runs, (long long)saving->tiles,
                 (long long)saving->pixels);
    const char *gap = "";
    for (int e = 0; e < WR_EFFECT_COUNT; e++) {
        if (!(saving->also >> e & 1)) continue;
        wr_text_addf(text, "%s\"%s\"", gap, wr_effects[e].rule);
        gap = ",";
    }
    wr_text_add(text, "]}");
}

static void add_json(WrText *text, const Explanation *explanation)
{
    const WrPlan *plan = explanation->plan;
    const WrFrame *frame = explanation->frame;
    wr_text_add(text, "{\"effects\":[");
    for (int i = 0; i < WR_EFFECT_COUNT; i++) {
        const WrPlanRow *e = &plan->rows[i];
        wr_text_addf(text, "%s{\"rule\":", i ? "," : "");
        wr_text_add_json_string(text, e->rule);
        wr_text_add(text, ",\"name\":");
        wr_text_add_json_string(text, e->name);
        wr_text_addf(text, ",\"run\":%s,\"class\":\"%s\",\"reason\":", e->run ? "true" : "false",
                     wr_proof_letter(e->proof));
        wr_text_add_json_string(text, e->reason);
        wr_text_addf(text, ",\"tiles\":%lld,\"pixels\":%lld,\"ns_per_pixel\":", (long long)e->tiles,
                     (long long)e->pixels);
        wr_text_add_json_number(text, e->ns_per_pixel);
        wr_text_add(text, ",\"seconds\":");
        wr_text_add_json_number(text, e->seconds);
        if (explanation->savings) add_json_saving(text, &explanation->savings[i]);
        wr_text_add(text, "}");
    }
    add_json_costs(text, plan);
    wr_text_addf(text, ",\"width\":%d,\"height\":%d,\"covered\":%lld,\"samples\":%lld,\"seconds\":",
                 frame->width, frame->height, (long long)frame->covered, (long long)frame->shaded);
    wr_text_add_json_number(text, frame->times.total);
    if (explanation->choice->dials) add_json_choice(text, explanation->choice);
    if (explanation->map) {
        wr_text_add(text, ",\"map\":[");
        map_legend_json(explanation->map, text);
        wr_text_add(text, "]");
    }
    wr_text_add(text, "}\n");
}

/* Print cost rows; the last line is their sum. */
static void add_costs(WrText *text, const WrPlan *plan)
{
    const double pixel = plan->shaded > 0 ? 1e9 / (double)plan->shaded : 0;
    for (int i = 0; i < WR_COST_COUNT; i++)
        if (plan->cost[i] > 0)
            wr_text_addf(text, "%-5s %-24s %-4s %-5s %9.1f  %s\n", "-", wr_cost_names[i], "yes",
                         "-", plan->cost[i] * pixel, wr_cost_reasons[i]);
    wr_text_addf(text, "%-5s %-24s %-4s %-5s %9.1f  %.2f ms of all threads together\n", "-", "all",
                 "", "", plan->work * pixel, 1e3 * plan->work);
}

/* Print "costs" or "saved", in ms, with a remark if any. */
static void add_saving(WrText *text, const WrSaving *saving)
{
    char costs[32] = "-", saved[32] = "-";
    snprintf(saving->run ? costs : saved, sizeof costs, "%.3f", 1e3 * saving->seconds);
    wr_text_addf(text, " %9s %9s %9.3f %7lld %9lld  %d runs", costs, saved, 1e3 * saving->spread,
                 (long long)saving->tiles, (long long)saving->pixels, saving->runs);
    if (saving->noise) wr_text_add(text, "; within noise");
    const char *gap = saving->run ? "; without it goes " : "; with it comes ";
    for (int e = 0; e < WR_EFFECT_COUNT; e++) {
        if (!(saving->also >> e & 1)) continue;
        wr_text_addf(text, "%s%s", gap, wr_effects[e].rule);
        gap = ", ";
    }
}

static void add_savings(WrText *text, const Explanation *explanation)
{
    wr_text_addf(text, "\n%-5s %-24s %-4s %9s %9s %9s %7s %9s  %s\n", "rule", "effect", "run",
                 "costs ms", "saved ms", "spread", "tiles", "pixels", "measured");
    for (int i = 0; i < WR_EFFECT_COUNT; i++) {
        const WrPlanRow *e = &explanation->plan->rows[i];
        const WrSaving *saving = &explanation->savings[i];
        wr_text_addf(text, "%-5s %-24s %-4s", e->rule, e->name, e->run ? "yes" : "no");
        if (saving->why_not)
            wr_text_addf(text, " %9s %9s %9s %7s %9s  %s", "-", "-", "-", "-", "-",
                         saving->why_not);
        else add_saving(text, saving);
        wr_text_add(text, "\n");
    }
}

static void add_table(WrText *text, const Explanation *explanation)
{
    const WrPlan *plan = explanation->plan;
    const WrChoice *choice = explanation->choice;
    const WrFrame *frame = explanation->frame;
    wr_text_addf(text, "%-5s %-24s %-4s %-5s %9s  %s\n", "rule", "effect", "run", "class",
                 "ns/pixel", "reason");
    for (int i = 0; i < WR_EFFECT_COUNT; i++) {
        const WrPlanRow *e = &plan->rows[i];
        char price[32] = "-";
        if (e->run && e->ns_per_pixel > 0) snprintf(price, sizeof price, "%.1f", e->ns_per_pixel);
        wr_text_addf(text, "%-5s %-24s %-4s %-5s %9s  %s\n", e->rule, e->name,
                     e->run ? "yes" : "no", wr_proof_letter(e->proof), price, e->reason);
    }
    add_costs(text, plan);
    if (explanation->savings) add_savings(text, explanation);
    if (choice->dials) {
        wr_text_addf(text, "\n%s\n", choice->reason);
        wr_choice_print(choice, text);
    }
    if (explanation->map) map_legend(explanation->map, text);
    wr_text_addf(text, "\n%dx%d pixels, %lld covered, %lld samples shaded, %.2f ms\n", frame->width,
                 frame->height, (long long)frame->covered, (long long)frame->shaded,
                 frame->times.total * 1e3);
}

/* Render the picture and print the explanation with the requested parts. */
static bool explain(const WrCli *cli, WrSession *session, WrText *text, WrError *err)
{
    WrFrame frame;
    WrPlan plan;
    WrSaving savings[WR_EFFECT_COUNT];
    WrHeatmapCounts map;
    if (!wr_session_frame(session, cli->width, cli->height, 0, &frame, err)) return false;
    plan = *frame.plan; /* plan of the first picture; later ones overwrite frame.plan */
    if (cli->measure && !wr_session_savings(session, cli->width, cli->height, 0, savings, err))
        return false;
    if (cli->map && !map_write(cli, session, &map, err)) return false;
    const Explanation explanation = { &plan, wr_session_choice(session), &frame,
                                      cli->measure ? savings : NULL, cli->map ? &map : NULL };
    if (cli->json) add_json(text, &explanation);
    else add_table(text, &explanation);
    return true;
}

/* ---- explain --layers ---- */

static void add_layer_row(WrText *text, int i, const char *name, const WrLayerPlan *plan)
{
    char ms[32] = "-";
    if (plan->seconds > 0.0) snprintf(ms, sizeof ms, "%.1f", 1e3 * plan->seconds);
    wr_text_addf(text, "%5d %-24.24s %-20s %-9s %9s %7zu %9.2f  %s\n", i + 1, name, plan->kind,
                 wr_layer_runs[plan->run], ms, plan->tiles, 1e-6 * (double)plan->bytes,
                 plan->reason);
}

static void add_layer_json(WrText *text, int i, const char *name, const WrLayerPlan *plan)
{
    wr_text_addf(text, "%s{\"layer\":%d,\"name\":", i ? "," : "", i + 1);
    wr_text_add_json_string(text, name);
    wr_text_addf(text, ",\"kind\":\"%s\",\"run\":\"%s\",\"reason\":\"%s\",", plan->kind,
                 wr_layer_runs[plan->run], plan->reason);
    add_json_seconds(text, "seconds", plan->seconds > 0.0, plan->seconds);
    wr_text_addf(text, "\"tiles\":%zu,\"bytes\":%zu}", plan->tiles, plan->bytes);
}

/* Composite the document and print the plan of its layers, from the top down as in the window. */
static bool explain_layers(const WrCli *cli, WrSession *session, WrText *text, WrError *err)
{
    const WrDocument *document = wr_session_document(session);
    if (!wr_document_whole(document, cli->pool, err)) return false;
    WrLayerPlan *plan = wr_alloc((size_t)document->layer_count, sizeof *plan);
    wr_session_layer_plan(session, plan);
    if (cli->json) wr_text_add(text, "{\"layers\":[");
    else
        wr_text_addf(text, "%5s %-24s %-20s %-9s %9s %7s %9s  %s\n", "layer", "name", "kind", "run",
                     "ms", "tiles", "MB", "reason");
    for (int k = 0; k < document->layer_count; k++) {
        const int i = cli->json ? k : document->layer_count - 1 - k;
        (cli->json ? add_layer_json : add_layer_row)(text, i, document->layers[i].name, &plan[i]);
    }
    if (cli->json) wr_text_add(text, "]}\n");
    wr_free(plan);
    return true;
}

int wr_cli_explain(const WrCli *cli)
{
    WrError err;
    WrText text = { 0 };
    WrSession *session = map_check(cli, &err) ? wr_cli_load(cli, false, &err) : NULL;
    const bool good =
        session && (cli->layers ? explain_layers : explain)(cli, session, &text, &err);
    const int status = good ? wr_cli_print(cli, &text) : wr_cli_fail(cli, WR_EXIT_FAILED, &err);
    wr_text_fini(&text);
    wr_session_free(session);
    return status;
}
