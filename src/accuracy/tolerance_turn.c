/* One choice for all frames of a turntable animation: chosen on a few frames spread over it, each block with the
   most expensive setting of any. Frames between those are tested, where the error is estimated at a fraction of
   a frame's cost. */
#include "accuracy/tolerance_internal.h"

#include "base/error.h"
#include "base/memory.h"
#include "base/text.h"
#include "system/clock.h"

#include <math.h>
#include <string.h>

#define STUDIED_MOST 4  /* frames for which dials are chosen ... */
#define STUDIED_SHARE 4 /* ... and at most one of this many */
#define LOOKED_SHARE 8  /* one of this many of each part's blocks is tested */
#define COARSER_LOOK                                                                               \
    1.3 /* error of the coarser, relative to the squared change by twice as many samples a side */

/* ---- union of the choices of two frames ---- */

/* The choice's part with the level of one part and the slopes and normal of the other; created if missing. */
static int find_part(WrChoice *choice, const WrChoicePart *level, const WrChoicePart *pair)
{
    const WrScene *wanted = pair->scene;
    for (int i = 0; i < choice->count; i++) {
        const WrScene *scene = choice->parts[i].scene;
        if (choice->parts[i].level == level->level && scene->scheme == wanted->scheme &&
            scene->bump == wanted->bump)
            return i;
    }
    WrChoicePart *part = &choice->parts[choice->count];
    *part = *level;
    part->scene = wr_scene_clone(level->scene);
    part->scene->scheme = wanted->scheme;
    part->scene->bump = wanted->bump;
    part->price = pair->price;
    part->blocks = 0;
    return choice->count++;
}

static int64_t blocks_of(const WrChoice *choice)
{
    return (int64_t)((choice->width + WR_FRAME_BLOCK - 1) / WR_FRAME_BLOCK) *
           ((choice->height + WR_FRAME_BLOCK - 1) / WR_FRAME_BLOCK);
}

static void count_blocks(WrChoice *choice)
{
    for (int i = 0; i < choice->count; i++) choice->parts[i].blocks = 0;
    for (int64_t b = 0; b < blocks_of(choice); b++)
        if (choice->part_of[b] != WR_CHOICE_NOTHING) choice->parts[choice->part_of[b]].blocks++;
}

/* The finest level and the most expensive slopes and normal of four blocks, two by two: features move between
   blocks during a turn. */
static void find_dearest(const WrChoice *choice, int64_t b, WrChoicePart *level, WrChoicePart *pair)
{
    const int64_t across = (choice->width + WR_FRAME_BLOCK - 1) / WR_FRAME_BLOCK;
    const int64_t u = b % across / 2 * 2, v = b / across / 2 * 2;
    for (int64_t n = 0; n < 4; n++) {
        const int64_t x = u + n % 2, at = (v + n / 2) * across + x;
        if (x >= across || at >= blocks_of(choice) || choice->part_of[at] == WR_CHOICE_NOTHING)
            continue;
        const WrChoicePart *part = &choice->parts[choice->part_of[at]];
        if (part->level > level->level) *level = *part;
        if (part->price > pair->price) *pair = *part;
    }
}

/* Each block gets the finest level and the most expensive slopes and normal of both. */
static void merge(WrChoice *sum, const WrChoice *more)
{
    for (int64_t b = 0; b < blocks_of(sum); b++) {
        const bool empty = sum->part_of[b] == WR_CHOICE_NOTHING;
        if (more->part_of[b] == WR_CHOICE_NOTHING) continue;
        WrChoicePart level = empty ? more->parts[more->part_of[b]] : sum->parts[sum->part_of[b]];
        WrChoicePart pair = level;
        find_dearest(more, b, &level, &pair);
        sum->part_of[b] = (unsigned char)find_part(sum, &level, &pair);
    }
    sum->met = sum->met && more->met;
    sum->rms = fmax(sum->rms, more->rms);
    sum->max = fmax(sum->max, more->max);
    sum->top_seconds = fmax(sum->top_seconds, more->top_seconds);
}

/* Blocks that are empty on all studied frames may contain the object on another: they get the finest setting,
   which costs nothing on empty blocks. */
static void fill_nothing(WrChoice *choice)
{
    int finest = 0;
    for (int i = 1; i < choice->count; i++) {
        const WrChoicePart *part = &choice->parts[i], *best = &choice->parts[finest];
        if (part->level > best->level || (part->level == best->level && part->price > best->price))
            finest = i;
    }
    for (int64_t b = 0; b < blocks_of(choice); b++)
        if (choice->part_of[b] == WR_CHOICE_NOTHING) choice->part_of[b] = (unsigned char)finest;
    count_blocks(choice);
}

/* ---- test of a frame ---- */

typedef struct Look {
    WrRenderer *renderer;
    const WrFrameRequest *request;
    const WrChoice *choice;
    float *coarse;       /* the frame as chosen */
    unsigned char *only; /* the tested blocks of a part */
    double squares, most;
} Look;

/* Selects one in LOOKED_SHARE of a part's blocks into `only`. Returns their number. */
static int64_t draw(const Look *look, int part)
{
    int64_t passed = 0, drawn = 0;
    for (int64_t b = 0; b < blocks_of(look->choice); b++) {
        look->only[b] =
            look->choice->part_of[b] == part && passed++ % LOOKED_SHARE == LOOKED_SHARE / 2;
        drawn += look->only[b];
    }
    return drawn;
}

static double add_difference(Look *look, const WrFrame *fine)
{
    const int blocks_u = (fine->width + WR_FRAME_BLOCK - 1) / WR_FRAME_BLOCK;
    double squares = 0;
    for (int y = 0; y < fine->height; y++)
        for (int x = 0; x < fine->width; x++) {
            const size_t at = 4 * ((size_t)y * (size_t)fine->width + (size_t)x);
            if (!look->only[(int64_t)(y / WR_FRAME_BLOCK) * blocks_u + x / WR_FRAME_BLOCK])
                continue;
            for (size_t c = at; c < at + 3; c++) {
                const double d = (double)fine->rgba[c] - (double)look->coarse[c];
                squares += d * d;
                look->most = fmax(look->most, fabs(d));
            }
        }
    return squares;
}

/* Renders some blocks of a part with twice as many samples a side, to estimate the error of all of it. */
static bool look_at_part(Look *look, int index, WrError *err)
{
    const WrChoicePart *part = &look->choice->parts[index];
    const int64_t drawn = draw(look, index);
    WrFrame fine;
    if (drawn == 0) return true;
    WrScene *scene = wr_scene_clone(part->scene);
    scene->dials.aa = WR_AA_SUPERSAMPLE;
    scene->dials.samples = 2 * wr_level_side(part->level);
    WrFrameRequest request = *look->request;
    request.scene = scene;
    request.dials = NULL;
    request.only = look->only;
    request.hold = true;
    const bool good = wr_renderer_frame(look->renderer, &request, &fine, err);
    if (good)
        look->squares +=
            COARSER_LOOK * add_difference(look, &fine) * (double)part->blocks / (double)drawn;
    wr_scene_free(scene);
    return good;
}

/* Approximate error of a frame of another turn with those dials; *seconds: time of the frame itself. */
static bool look_at(WrRenderer *renderer, const WrFrameRequest *request, const WrChoice *choice,
                    double *rms, double *most, double *seconds, WrError *err)
{
    WrFrame frame;
    const double start = wr_clock_seconds();
    if (!wr_choice_frame(renderer, request, choice, &frame, err)) return false;
    *seconds = wr_clock_seconds() - start;
    const size_t floats = (size_t)4 * (size_t)frame.width * (size_t)frame.height;
    Look look = { .renderer = renderer, .request = request, .choice = choice };
    look.coarse = wr_try_alloc(floats, sizeof(float), "a picture", err);
    if (!look.coarse) return false;
    look.only = wr_alloc((size_t)blocks_of(choice), 1);
    memcpy(look.coarse, frame.rgba, floats * sizeof(float));
    bool good = true;
    for (int i = 0; good && i < choice->count; i++) good = look_at_part(&look, i, err);
    *rms = sqrt(look.squares / (3 * fmax(1, (double)frame.covered)));
    *most = look.most;
    wr_free(look.coarse);
    wr_free(look.only);
    return good;
}

/* ---- all frames ---- */

typedef struct Turn {
    WrRenderer *renderer;
    WrFrameRequest request;
    WrChoice choice;
    int studied, checked, again; /* numbers of frames */
    double study_seconds, frame_seconds, rms;
} Turn;

static bool study(Turn *turn, double turn_deg, WrError *err)
{
    WrFrame frame;
    WrChoice one = { 0 };
    turn->request.turn_deg = turn_deg;
    if (!wr_tolerance_choose(turn->renderer, &turn->request, &one, &frame, err)) return false;
    turn->study_seconds += one.spent;
    if (turn->studied++ == 0) {
        turn->choice = one;
        merge(&turn->choice, &turn->choice);
        return true;
    }
    merge(&turn->choice, &one);
    wr_choice_fini(&one);
    return true;
}

/* Tests a frame. If the choice fails there, that frame is studied too. */
static bool check(Turn *turn, double turn_deg, WrError *err)
{
    const WrTolerance *tolerance = &turn->request.scene->tolerance;
    double rms, most, seconds;
    turn->request.turn_deg = turn_deg;
    if (!look_at(turn->renderer, &turn->request, &turn->choice, &rms, &most, &seconds, err))
        return false;
    turn->checked++;
    turn->frame_seconds += seconds;
    const bool broken = (tolerance->kind == WR_TOLERANCE_RMS && rms > tolerance->value) ||
                        (tolerance->kind == WR_TOLERANCE_MAX && most > tolerance->value);
    if (!broken || !turn->choice.met) {
        turn->rms = fmax(turn->rms, rms);
        return true;
    }
    turn->again++;
    if (!study(turn, turn_deg, err)) return false;
    fill_nothing(&turn->choice);
    return true;
}

static void say_turn(Turn *turn, int count, double spent)
{
    const WrTolerance *tolerance = &turn->request.scene->tolerance;
    WrChoice *choice = &turn->choice;
    const double each = turn->checked > 0 ? turn->frame_seconds / turn->checked : choice->seconds;
    const double anew = turn->study_seconds / turn->studied, gain = anew - each;
    WrText text = { 0 };
    wr_text_addf(&text, "tolerance %s=", wr_tolerance_names[tolerance->kind]);
    wr_text_add_number(&text, tolerance->value);
    wr_text_addf(&text,
                 "%s, %d frames: %s; dials chosen on %d of them for all, looked at on %d others%s; "
                 "estimated rms at most %.2g; choosing took %.1f ms, each frame takes %.1f; ",
                 tolerance->kind == WR_TOLERANCE_TIME ? " s" : "", count,
                 choice->met ? "met" : "CANNOT be promised by any setting: the nearest was taken",
                 turn->studied, turn->checked, turn->again > 0 ? ", which mended them" : "",
                 fmax(choice->rms, turn->rms), 1e3 * spent, 1e3 * each);
    if (gain > 0 && spent / gain < 1e6)
        wr_text_addf(&text, "against choosing for each it pays from frame %d on",
                     (int)ceil(spent / gain));
    else wr_text_add(&text, "against choosing for each it never pays");
    snprintf(choice->reason, sizeof choice->reason, "%s", wr_text_get(&text));
    wr_text_fini(&text);
    choice->seconds = each;
    choice->spent = spent;
}

bool wr_tolerance_turn(WrRenderer *renderer, const WrFrameRequest *request, const double *turn_deg,
                       int count, WrChoice *out, WrError *err)
{
    Turn turn = { .renderer = renderer, .request = *request };
    const double start = wr_clock_seconds();
    const int share = count / STUDIED_SHARE;
    const int studied = share < 1 ? 1 : share < STUDIED_MOST ? share : STUDIED_MOST;
    bool good = true;
    for (int i = 0; good && i < studied; i++)
        good = study(&turn, turn_deg[(int64_t)i * count / studied], err);
    if (good) fill_nothing(&turn.choice);
    for (int i = 0; good && i < studied && count > 1; i++) {
        const int at = (int)((2 * (int64_t)i + 1) * count / (2 * studied));
        good = check(&turn, turn_deg[at < count ? at : count - 1], err);
    }
    if (!good) {
        wr_choice_fini(&turn.choice);
        return false;
    }
    turn.choice.turning = true;
    turn.choice.studies = turn.studied;
    say_turn(&turn, count, wr_clock_seconds() - start);
    wr_choice_fini(out);
    *out = turn.choice;
    return true;
}
