/* tolerance.h - choice of one setting for a whole picture under an error tolerance, with the resulting picture.

   1. A table has the price and the expected error of each setting: slopes, normal, mesh and samples. Prices are
      counted work (tolerance_cost.c). The first expectations are low: a cheap setting that fails costs little.
   2. The cheapest setting whose expected error is below the tolerance renders the picture.
   3. Check: up to 64 blocks of WR_FRAME_BLOCK pixels (128 for max=) are rendered with the best slopes and normal, a
      finer mesh and more samples. They are drawn at random with a constant seed, those with more variation more often.
   4. If the picture missed, measured errors replace the expected ones, and the cheapest setting that meets the
      tolerance by them renders it again. The same blocks are checked. There is no second correction.
   5. The reason states the measured error, and whether the tolerance was met or MISSED.
   For time= the setting is the best that fits the time, by its price and the speed of this machine; the check only
   measures its error. Otherwise no clock is involved: the same table, scene, size and tolerance give the same
   setting, on any machine and any number of threads.

   Limits. The error is that of a sample of the pixels: rms is raised by its standard error, max by a third. The
   check stands for the reference: errors of arithmetic and of stored heights remain as in the scene and are not
   counted. An object that no pixel's centre meets is not seen. */
#pragma once
#include "base/hash.h"
#include "render/plan/plan.h"

#include <stdbool.h>
#include <stdint.h>

typedef struct WrError WrError;
typedef struct WrFrame WrFrame;
typedef struct WrFrameRequest WrFrameRequest;
typedef struct WrRenderer WrRenderer;
typedef struct WrScene WrScene;
typedef struct WrText WrText;

typedef struct WrChoice {
    WrScene *dials; /* the scene with the chosen dials, without tolerance; owned; NULL: no choice */
    int width, height;
    bool met;         /* the measured error is within the tolerance (time=: the expected time) */
    double rms, max;  /* measured error of the picture */
    double seconds;   /* time of one further such frame; 0: unknown */
    double spent;     /* seconds spent on choosing, including the picture */
    char reason[480]; /* one or two sentences */
    bool shown;       /* set by the caller after showing the reason to the user */
    int frames;       /* number of frames rendered for it, those of the checks included */
    int studies;      /* number of pictures studied for it; 0: it was read from text */
    WrPlan plan;      /* costs of its last picture: the frame's plan */
    /* The picture that it belongs to. */
    const WrScene *scene; /* shared; owned */
    uint64_t tables_key;  /* wr_choice_tables_key */
    double turn_deg;
    bool turning; /* valid for any turn */
} WrChoice;

/* Chooses for the request's picture under its scene's tolerance, and returns the picture: *frame has the counts,
   times and plan of everything rendered for it; the plan is owned by the choice. The renderer's caches are used;
   its last picture is lost. Zero-initialise *out. Errors: the scene has no tolerance; those of frames. */
bool wr_tolerance_choose(WrRenderer *renderer, const WrFrameRequest *request, WrChoice *out,
                         WrFrame *frame, WrError *err);
/* The request's picture under its scene's tolerance: by *choice if that belongs to the same table, scene, turn
   (or any turn) and size, else chosen again into *choice. */
bool wr_tolerance_frame(WrRenderer *renderer, const WrFrameRequest *request, WrChoice *choice,
                        WrFrame *frame, WrError *err);
/* One choice for all frames of a turntable animation with those angles: the finest of the settings chosen on up to
   eight frames spread over it, at most a quarter of them. Returns no picture; reason states these frames. */
bool wr_tolerance_turn(WrRenderer *renderer, const WrFrameRequest *request, const double *turn_deg,
                       int count, WrChoice *out, WrError *err);
void wr_choice_fini(WrChoice *choice);

/* Renders the request's picture with the chosen dials. */
bool wr_choice_frame(WrRenderer *renderer, const WrFrameRequest *request, const WrChoice *choice,
                     WrFrame *frame, WrError *err);
/* Identity of the tables of a picture's objects: a key valid in this process, and a hash. */
uint64_t wr_choice_tables_key(const WrFrameRequest *request);
WrHash wr_choice_tables_hash(const WrFrameRequest *request);
/* True if it belongs to the request's tables, scene, size and turn (or is valid for any turn). */
bool wr_choice_fits(const WrChoice *choice, const WrFrameRequest *request);
/* "whole picture: scheme=... mode=... aa=adaptive samples=4 ..." and a newline. */
void wr_choice_print(const WrChoice *choice, WrText *text);

/* ---- text form: choice_text.c ---- */

/* Identity of the table and scene, tolerance included, that a choice was made for; its size and turn are in the
   choice. */
typedef struct WrChoiceOrigin {
    WrHash table, scene;
} WrChoiceOrigin;

/* Writes the choice as one line of text, from which wr_choice_read restores the same picture, bit for bit. */
void wr_choice_write(const WrChoice *choice, const WrChoiceOrigin *origin, WrText *text);
/* Validates such a text. Errors state the damage. Texts of earlier versions, with a setting for each block, are
   valid, but fit no picture. */
bool wr_choice_check(const char *text, WrError *err);
/* For a valid text: the property that does not match, "program", "table", "scene", "size" or "turn"; NULL: it
   fits. */
const char *wr_choice_misfit(const char *text, const WrChoiceOrigin *origin,
                             const WrFrameRequest *request);
/* For a valid text: true if it belongs to that table and scene, at any size and turn. */
bool wr_choice_is_for(const char *text, const WrChoiceOrigin *origin);
/* Reads a valid, matching text as the request's choice. */
void wr_choice_read(const char *text, const WrFrameRequest *request, WrChoice *out);
