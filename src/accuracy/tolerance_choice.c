/* What was chosen: its parts, its picture, its words. */
#include "accuracy/tolerance_inner.h"

#include "base/memory.h"

#include <string.h>

static const char *const names[STRATA] = {
    "empty blocks", "soft edges",  "edges",  "still inside",
    "calm inside",  "soft relief", "relief", "rough relief"
};

/* ---- making it ---- */

/* Which grades of a stratum have that place: "edges", "the liveliest edges". */
static void name_grades(const Study *study, const Place places[KINDS], Place place, int stratum,
                        WrText *text)
{
    int first = -1, last = -1, liveliest = -1, calmest = -1;
    for (int g = 0; g < GRADES; g++) {
        const int k = wr_kind(stratum, g);
        if (study->blocks[k] == 0) continue;
        if (liveliest < 0) liveliest = g;
        calmest = g;
        if (!wr_same_place(places[k], place)) continue;
        if (first < 0) first = g;
        last = g;
    }
    if (first < 0) return;
    if (text->length > 0) wr_text_add(text, ", ");
    if (first > liveliest) wr_text_add(text, last < calmest ? "middling " : "the calmest ");
    else if (last < calmest) wr_text_add(text, "the liveliest ");
    wr_text_add(text, names[stratum]);
}

static void name_part(const Study *study, const Place places[KINDS], Place place,
                      WrChoicePart *part)
{
    WrText text = { 0 };
    for (int s = 1; s < STRATA; s++) name_grades(study, places, place, s, &text);
    snprintf(part->where, sizeof part->where, "%s", wr_text_get(&text));
    wr_text_fini(&text);
}

/* Seconds of the whole picture with 16 x 16 samples of the best slopes and normal. */
static double best_seconds(const Study *study)
{
    const double side =
        (double)wr_study_ways[WAY_SIXTEEN].samples / wr_study_ways[study->top].samples;
    double sum = 0;
    for (int k = 1; k < KINDS; k++)
        if (study->blocks[k] > 0)
            sum += side * side * wr_study_seconds(study, k, wr_best_place(study, study->top));
    return sum;
}

void wr_study_settle(const Study *study, const Place places[KINDS], WrChoice *out)
{
    int part_of[KINDS] = { 0 }, cheapest = 0;
    out->width = study->request->width;
    out->height = study->request->height;
    out->share = (double)study->sample_count / (double)study->block_count;
    out->top_seconds = best_seconds(study);
    out->parts = wr_alloc(KINDS, sizeof *out->parts);
    for (int k = 1; k < KINDS; k++) {
        if (study->blocks[k] == 0) continue;
        part_of[k] = -1;
        for (int other = 1; other < k && part_of[k] < 0; other++)
            if (study->blocks[other] > 0 && wr_same_place(places[other], places[k]))
                part_of[k] = part_of[other];
        if (part_of[k] < 0) {
            WrChoicePart *part = &out->parts[part_of[k] = out->count++];
            part->scene = wr_study_scene(study, places[k]);
            name_part(study, places, places[k], part);
            if (part->scene->dials.samples < out->parts[cheapest].scene->dials.samples)
                cheapest = part_of[k];
        }
        out->parts[part_of[k]].blocks += study->blocks[k];
    }
    if (out->count == 0) out->parts[out->count++].scene = wr_study_scene(study, places[0]);
    out->part_of = wr_alloc((size_t)study->block_count, 1);
    for (int64_t b = 0; b < study->block_count; b++) {
        const int k = study->block[b].kind;
        out->part_of[b] = (unsigned char)(k > 0 ? part_of[k] : cheapest);
    }
}

void wr_choice_fini(WrChoice *choice)
{
    for (int i = 0; i < choice->count; i++) wr_scene_free(choice->parts[i].scene);
    wr_free(choice->parts);
    wr_free(choice->part_of);
    *choice = (WrChoice){ 0 };
}

/* ---- using it ---- */

static void add_times(WrStageTimes *sum, const WrStageTimes *more)
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

bool wr_choice_frame(WrRenderer *renderer, const WrFrameRequest *request, const WrChoice *choice,
                     WrFrame *frame, WrError *err)
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
        pass.only = choice->count > 1 ? only : NULL;
        pass.keep = false;
        pass.hold = true; /* the next picture's choosing wants them all */
        good = wr_renderer_frame(renderer, &pass, frame, err);
        sum.covered += frame->covered;
        sum.shaded += frame->shaded;
        add_times(&sum.times, &frame->times);
    }
    frame->covered = sum.covered;
    frame->shaded = sum.shaded;
    frame->times = sum.times;
    wr_free(only);
    return good;
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
