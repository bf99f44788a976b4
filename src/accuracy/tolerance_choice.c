/* A choice: its parts, its picture, its description. */
#include "accuracy/tolerance_internal.h"

#include "base/error.h"
#include "base/memory.h"
#include "base/enum_rows.h"
#include "base/text.h"
#include "field/field.h"

#include <string.h>

/* ---- construction ---- */

WR_ROWS(kind_names);
static const char *const kind_names[KIND_COUNT] = { [WR_ROW(KIND_EDGE)] = "edges",
                                                    [WR_ROW(KIND_CALM)] = "calm insides",
                                                    [WR_ROW(KIND_RELIEF)] = "relief",
                                                    [WR_ROW(KIND_ROUGH)] = "rough relief" };
WR_ROWS_END(kind_names, KIND_COUNT);
/* Limits between the kinds that are not edges: root mean square of linear intensity. */
static const double kind_ends[] = { 0.006, 0.03 };
_Static_assert(WR_LENGTH(kind_ends) == KIND_COUNT - KIND_CALM - 1, "an end between two kinds");

static int kind_of(const Block *block)
{
    const double per_value = block->change[1].squares / (3.0 * WR_FRAME_BLOCK * WR_FRAME_BLOCK);
    int kind = KIND_CALM;
    if (block->edge) return KIND_EDGE;
    for (size_t i = 0; i < sizeof kind_ends / sizeof *kind_ends; i++)
        kind += per_value > kind_ends[i] * kind_ends[i];
    return kind;
}

static int setting_of(const Block *block)
{
    return block->pair * LEVELS + block->pick;
}

/* Kinds of the blocks with that setting. */
static unsigned kinds_of(const Study *study, int setting)
{
    int64_t all[KIND_COUNT] = { 0 }, here[KIND_COUNT] = { 0 };
    unsigned kinds = 0;
    for (int64_t b = 0; b < study->count; b++) {
        const Block *block = &study->block[b];
        if (!block->shown) continue;
        all[kind_of(block)]++;
        here[kind_of(block)] += setting_of(block) == setting;
    }
    for (int k = 0; k < KIND_COUNT; k++) {
        const unsigned has = here[k] == 0           ? HAS_NONE
                             : here[k] == all[k]    ? HAS_ALL
                             : 2 * here[k] > all[k] ? HAS_MOST
                                                    : HAS_SOME;
        kinds |= has << (KIND_BITS * k);
    }
    return kinds;
}

void wr_part_name(WrChoicePart *part)
{
    static const char *const share[] = { "", "some of the ", "most of the ", "" };
    WrText text = { 0 };
    for (int k = 0; k < KIND_COUNT; k++) {
        const unsigned has = part->kinds >> (KIND_BITS * k) & 3;
        if (has != HAS_NONE)
            wr_text_addf(&text, "%s%s%s", text.length > 0 ? ", " : "", share[has], kind_names[k]);
    }
    snprintf(part->where, sizeof part->where, "%s", wr_text_get(&text));
    wr_text_fini(&text);
}

void wr_choice_say(WrChoice *choice, const WrTolerance *tolerance, const char *more)
{
    WrText text = { 0 };
    wr_text_addf(&text, "tolerance %s=", wr_tolerance_names[tolerance->kind]);
    wr_text_add_number(&text, tolerance->value);
    wr_text_addf(&text, "%s: %s; estimated rms %.2g, max %.2g; %s",
                 tolerance->kind == WR_TOLERANCE_TIME ? " s" : "",
                 choice->met ? "met" : "CANNOT be promised by any setting: the nearest was taken",
                 choice->rms, choice->max, more);
    snprintf(choice->reason, sizeof choice->reason, "%s", wr_text_get(&text));
    wr_text_fini(&text);
}

void wr_study_settle(const Study *study, WrChoice *out)
{
    int part_of[PARTS_MAX];
    out->width = study->request->width;
    out->height = study->request->height;
    out->scene = wr_scene_share(study->request->scene);
    out->tables_key = wr_choice_tables_key(study->request);
    out->turn_deg = study->request->turn_deg;
    out->studies = 1;
    out->frames = study->frames;
    out->parts = wr_alloc(PARTS_MAX, sizeof *out->parts);
    out->part_of = wr_alloc((size_t)study->count, 1);
    for (int i = 0; i < PARTS_MAX; i++) part_of[i] = -1;
    for (int64_t b = 0; b < study->count; b++) {
        const Block *block = &study->block[b];
        out->part_of[b] = WR_CHOICE_NOTHING;
        if (!block->shown) continue;
        const int setting = setting_of(block);
        if (part_of[setting] < 0) {
            WrChoicePart *part = &out->parts[part_of[setting] = out->count++];
            part->scene = wr_study_scene(study, block->pair, block->pick);
            part->level = block->pick;
            part->price = study->pair[block->pair].price;
            part->kinds = kinds_of(study, setting);
            wr_part_name(part);
        }
        out->part_of[b] = (unsigned char)part_of[setting];
        out->parts[part_of[setting]].blocks++;
    }
    if (out->count == 0) out->parts[out->count++].scene = wr_study_scene(study, 0, 0);
}

void wr_choice_fini(WrChoice *choice)
{
    for (int i = 0; i < choice->count; i++) wr_scene_free(choice->parts[i].scene);
    wr_scene_free((WrScene *)choice->scene);
    wr_free(choice->parts);
    wr_free(choice->part_of);
    *choice = (WrChoice){ 0 };
}
/* ---- use ---- */

/* Clears the blocks without the object, which are not rendered. */
static void clear_nothing(const WrChoice *choice, WrFrame *frame)
{
    const int blocks_u = (choice->width + WR_FRAME_BLOCK - 1) / WR_FRAME_BLOCK;
    for (int y = 0; y < choice->height; y++)
        for (int u = 0; u < blocks_u; u++) {
            const int x = u * WR_FRAME_BLOCK, left = choice->width - x;
            const int w = left < WR_FRAME_BLOCK ? left : WR_FRAME_BLOCK;
            if (choice->part_of[(int64_t)(y / WR_FRAME_BLOCK) * blocks_u + u] == WR_CHOICE_NOTHING)
                memset(frame->rgba + 4 * ((size_t)y * (size_t)choice->width + (size_t)x), 0,
                       4 * (size_t)w * sizeof(float));
        }
}

bool wr_choice_frame_plan(WrRenderer *renderer, const WrFrameRequest *request,
                          const WrChoice *choice, WrPlan *plan, WrFrame *frame, WrError *err)
{
    const int64_t blocks = (int64_t)((choice->width + WR_FRAME_BLOCK - 1) / WR_FRAME_BLOCK) *
                           ((choice->height + WR_FRAME_BLOCK - 1) / WR_FRAME_BLOCK);
    WrFrame sum = { 0 };
    bool good = true;
    if (request->width != choice->width || request->height != choice->height)
        return wr_fail(err, "the dials were chosen for %dx%d pixels, not %dx%d", choice->width,
                       choice->height, request->width, request->height);
    unsigned char *only = wr_alloc((size_t)blocks, 1);
    for (int i = 0; good && i < choice->count; i++) {
        WrFrameRequest pass = *request;
        for (int64_t b = 0; b < blocks; b++) only[b] = choice->part_of[b] == i;
        pass.scene = choice->parts[i].scene;
        pass.dials = NULL;
        pass.only = only;
        pass.keep = false;
        pass.hold = true; /* the next picture's choice needs them all */
        good = wr_renderer_frame(renderer, &pass, frame, err);
        if (!good) break;
        if (plan) wr_plan_add(plan, frame->plan);
        sum.shaded += frame->shaded;
        wr_times_add(&sum.times, &frame->times);
    }
    wr_free(only);
    if (!good) return false;
    clear_nothing(choice, frame);
    frame->covered = wr_frame_covered(frame);
    frame->shaded = sum.shaded;
    frame->times = sum.times;
    if (plan) frame->plan = plan;
    return true;
}

bool wr_choice_frame(WrRenderer *renderer, const WrFrameRequest *request, const WrChoice *choice,
                     WrFrame *frame, WrError *err)
{
    return wr_choice_frame_plan(renderer, request, choice, NULL, frame, err);
}

void wr_choice_print(const WrChoice *choice, WrText *text)
{
    int64_t all = 0;
    for (int i = 0; i < choice->count; i++) all += choice->parts[i].blocks;
    for (int i = 0; i < choice->count; i++) {
        const WrChoicePart *part = &choice->parts[i];
        if (part->blocks == 0) continue;
        WrText bump = { 0 }, dials = { 0 };
        wr_dials_print(part->scene, "bump", true, &bump);
        wr_dials_print(part->scene, "dials", false, &dials);
        wr_text_addf(text, "%.1f %% of the blocks, %s: %s %s\n",
                     100.0 * (double)part->blocks / (double)all, part->where, wr_text_get(&bump),
                     wr_text_get(&dials));
        wr_text_fini(&bump);
        wr_text_fini(&dials);
    }
}

/* ---- frames of several passes ---- */

void wr_times_add(WrStageTimes *sum, const WrStageTimes *more)
{
    sum->prepare += more->prepare;
    sum->visibility += more->visibility;
    sum->geometry += more->geometry;
    sum->bump += more->bump;
    sum->shade += more->shade;
    sum->resolve += more->resolve;
    sum->total += more->total;
    sum->pyramid += more->pyramid;
}

int64_t wr_frame_covered(const WrFrame *frame)
{
    const size_t pixels = (size_t)frame->width * (size_t)frame->height;
    int64_t covered = 0;
    for (size_t i = 0; i < pixels; i++) covered += frame->rgba[4 * i + 3] > 0;
    return covered;
}
