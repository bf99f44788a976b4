/* accuracy.h - what the Accuracy panel, the comparisons on the patch, the inspector and the gallery of hard cases
   hold. Everything that takes longer than a moment is done by threads in the background, from snapshots, only
   while the view rests and somebody looks; what is outdated is cancelled. */
#pragma once
#include "ui/accuracy/accuracy_work.h"
#include "ui/state/app_state.h"
#include "ui/state/roster.h"
#include "ui/preview/preview.h"
#include "ui/jobs/job.h"

#include "hardcases/hardcases.h"
#include "base/error.h"
#include "render/reference/reference.h"
#include "scene/dials.h"

#include <SDL.h>
#include <stdbool.h>
#include <stdint.h>

typedef struct WrField WrField;
typedef struct WrJob WrJob;
typedef struct WrScene WrScene;
typedef struct WrText WrText;

/* What the patch's view shows. */
typedef enum WrPatchLook {
    WR_PATCH_PLAIN,
    WR_PATCH_SPLIT,   /* A, the scene, left of a line; B, other dials, right of it */
    WR_PATCH_FLICKER, /* A and B, one after the other */
    WR_PATCH_ERROR,   /* distance from the reference */
    WR_PATCH_DROPPED, /* what the small-F approximation leaves out, degrees */
    WR_PATCH_TILT,    /* between n and n', degrees */
    WR_PATCH_LEVEL,   /* mip level */
    WR_PATCH_HEIGHT,  /* F */
    WR_PATCH_NORMAL,  /* n', as colours */
    WR_PATCH_LACKS,   /* what bump lacks of displacement: outline red, shading green, shadow blue */
    WR_PATCH_RAN,     /* where each effect ran: the preview's own picture, live as that is */
    WR_PATCH_LOOKS
} WrPatchLook;
extern const char *const wr_patch_look_names[WR_PATCH_LOOKS]; /* for people */

/* A picture laid over the patch. */
typedef struct WrPatchLayer {
    SDL_Texture *texture; /* owned */
    int width, height;    /* pixels of it; 0: none */
    uint64_t of;          /* the state that it shows */
    int look;             /* and of maps: which */
    double low, full;     /* the values at the ends of its scale */
} WrPatchLayer;

typedef struct WrInspector {
    bool shown;  /* its tab is */
    bool pinned; /* it stays at its place */
    bool have;   /* there is a place */
    bool on_table;
    double x, y; /* of the place: shares of the view; u, v of the patch */
    WrProbe probe;
    char object[64];   /* of several, which it is about; "" of the only one */
    bool known, seen;  /* probe holds; see WrWork.seen */
    uint64_t asked_of; /* state that was asked about last */
    bool asked_table;
    double asked_x, asked_y;
    bool copied; /* what it shows is on the clipboard */
} WrInspector;

typedef struct WrCases { /* the gallery of hard cases */
    char filter[80];
    const WrHardCase *chosen; /* NULL: none */
    WrHardReport *report;     /* owned; NULL: not measured yet */
    bool wanted;              /* to be measured when nothing else is */
} WrCases;

struct WrAccuracy {
    /* of what the view shows */
    WrField *field; /* own shares */
    WrTables *tables;
    WrScene *scene;
    double turn_deg;
    int width, height;
    uint64_t state;             /* counts what was seen so far */
    double changed_at;          /* clock */
    bool error_open, plot_open; /* somebody looks at them, in the last picture of the window */

    WrWorkTools measure_tools, look_tools, probe_tools;
    WrJob *measure, *looker, *prober;
    bool measuring;      /* something is under way there ... */
    WrWorkKind measures; /* ... this */

    WrWork *error;     /* newest result, owned; NULL: none */
    uint64_t error_of; /* state that was measured, or could not be */
    WrError error_why; /* why not; "" */
    WrWork *plot;      /* newest ladder, owned; NULL: none */
    char *plot_base;   /* the scene without its dials that it is about, owned */
    uint64_t plot_key; /* of the table; and the picture's turn */
    double plot_turn;
    uint64_t plot_failed; /* state for which there is none */
    uint64_t fits_of;     /* state that the next two are known for; 0: none */
    bool fits;            /* the plot is of this table and this scene, but for its dials */
    int rung;             /* of it with the scene's dials, -1: none */
    bool plot_asked;
    WrWork *illusion;     /* newest, owned; NULL: none */
    bool illusion_wanted; /* to be measured when nothing else is */
    int plot_hot;         /* point under the pointer, -1: none */

    WrPatchLook look;
    double split; /* share of the view left of the line */
    bool hold_b;  /* the key that shows B is held */
    SDL_Keycode hold_key;
    double flicker_since;
    bool flicker_shown; /* B, in the last picture of the window */
    int chooses;        /* what the dials and the plot set: 0 A, 1 B */
    double b[WR_DIAL_COUNT];
    bool b_given;
    uint64_t b_serial, look_serial; /* of B's dials: now, and when it was asked for */
    uint64_t look_of; /* state that pictures or a map were asked for, or could not be had */
    int look_kind;
    WrPatchLayer pair[2], map;

    WrPreviewPicture full_times; /* times and size of the last sharp picture of the preview */
    WrInspector inspector;
    WrCases cases;
};

/* Which map it takes, of those that are measured by the reference. */
WrProbeMap wr_accuracy_map_of(WrPatchLook look);

/* ---- accuracy_input.c ---- */
void wr_accuracy_new(WrApp *app);
void wr_accuracy_free(WrApp *app);
/* Take what is done, begin what is due; once before each picture. */
void wr_accuracy_update(WrApp *app);
/* Something is measured or about to be; two pictures that are shown in turn do not count. */
bool wr_accuracy_under_way(const WrApp *app);
double wr_accuracy_next_time(const WrApp *app); /* clock at which that must be; 0: only on events */
bool wr_accuracy_works(WrApp *app);             /* a bar of ours moves */
void wr_accuracy_forget(WrApp *app);            /* textures were lost */
bool wr_accuracy_rests(const WrApp *app);       /* nothing is held or drawn, nothing turns */
/* Is a ladder there, for the table and the scene but for its dials? */
bool wr_accuracy_plot_fits(const WrApp *app);
/* The rung of a ladder that fits with the scene's dials, or -1. */
int wr_accuracy_rung(const WrApp *app);
bool wr_accuracy_busy(WrApp *app, WrWorkKind kind, double *fraction);

/* ---- accuracy_set.c: dials of A, by commands, and of B ---- */
/* A's dial: of the scene; B's: as last chosen, else the best of all. */
double wr_accuracy_dial(const WrApp *app, int side, int dial);
void wr_accuracy_set_dial(WrApp *app, int side, int dial, double value);
/* All dials as a rung of the ladder has them. */
void wr_accuracy_take_rung(WrApp *app, int side, int rung);
void wr_accuracy_b_from_a(WrApp *app);
void wr_accuracy_swap(WrApp *app);
/* The scene with the dials of A or B, without tolerance. The caller frees it. */
WrScene *wr_accuracy_scene(const WrApp *app, int side);
/* The dials that the tolerance chose where they are finest become the scene's, the tolerance goes. */
void wr_accuracy_keep(WrApp *app);
/* A's or B's dials in a few words. */
void wr_accuracy_words(const WrApp *app, int side, WrText *text);

/* ---- accuracy_view.c: over the patch ---- */
void wr_accuracy_show(WrApp *app, WrPatchLook look);
void wr_accuracy_draw(WrApp *app);    /* pictures, over the preview's */
void wr_accuracy_overlay(WrApp *app); /* labels, line, scale */
bool wr_accuracy_on_line(const WrApp *app, double x,
                         double y); /* the pointer would grasp the line */
void wr_accuracy_drag_line(WrApp *app, double x);
/* A finished picture or map becomes a texture. */
void wr_accuracy_lay(WrApp *app, const WrWork *work);

/* ---- panels ---- */
void wr_panel_accuracy(WrApp *app);
void wr_panel_accuracy_dials(WrApp *app);     /* panel_accuracy_dials.c */
void wr_panel_accuracy_tolerance(WrApp *app); /* the same */
void wr_panel_illusion(WrApp *app);           /* panel_illusion.c */
void wr_panel_accuracy_plot(WrApp *app);      /* panel_accuracy_plot.c */
void wr_panel_inspector(WrApp *app);          /* panel_inspector.c */
void wr_inspector_follow(WrApp *app);         /* its place, before each picture */
void wr_dialog_cases(WrApp *app);             /* panel_cases.c */
void wr_dialog_cases_open(WrApp *app);

/* ---- actions_accuracy.c ---- */
void wr_act_accuracy(WrApp *app);
void wr_act_inspector(WrApp *app);
void wr_act_inspector_pin(WrApp *app);
void wr_act_inspector_copy(WrApp *app);
void wr_act_look_plain(WrApp *app);
void wr_act_look_split(WrApp *app);
void wr_act_look_flicker(WrApp *app);
void wr_act_look_error(WrApp *app);
void wr_act_look_dropped(WrApp *app);
void wr_act_look_tilt(WrApp *app);
void wr_act_look_level(WrApp *app);
void wr_act_look_height(WrApp *app);
void wr_act_look_normal(WrApp *app);
void wr_act_look_ran(WrApp *app);
void wr_act_accuracy_measure(WrApp *app);
void wr_act_compare_take(WrApp *app);
void wr_act_compare_swap(WrApp *app);
void wr_act_compare_hold(
    WrApp *app); /* of the hand: held by its key; chosen in a menu it toggles */
bool wr_is_accuracy(const WrApp *app);
bool wr_is_inspector(const WrApp *app);
bool wr_is_inspector_pinned(const WrApp *app);
bool wr_is_look_plain(const WrApp *app);
bool wr_is_look_split(const WrApp *app);
bool wr_is_look_flicker(const WrApp *app);
bool wr_is_look_error(const WrApp *app);
bool wr_is_look_dropped(const WrApp *app);
bool wr_is_look_tilt(const WrApp *app);
bool wr_is_look_level(const WrApp *app);
bool wr_is_look_height(const WrApp *app);
bool wr_is_look_normal(const WrApp *app);
bool wr_is_look_ran(const WrApp *app);
bool wr_is_compare_hold(const WrApp *app);

extern const WrPart wr_part_accuracy;
