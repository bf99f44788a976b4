/* accuracy.h - state of the Accuracy panel, the comparisons on the patch, the inspector and the hard-case gallery.
   Long computations run on background threads, on snapshots, only while the view is static and a panel shows the
   result; outdated ones are cancelled. */
#pragma once
#include "ui/panels/accuracy/accuracy_work.h"
#include "ui/app/state/app_state.h"
#include "ui/app/state/registry.h"
#include "ui/patch/preview/preview.h"
#include "ui/app/jobs/job.h"

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

/* Picture shown in the patch view. */
typedef enum WrPatchLook {
    WR_PATCH_PLAIN,
    WR_PATCH_SPLIT,   /* A, the scene, left of a divider; B, other dials, right of it */
    WR_PATCH_FLICKER, /* A and B, alternating */
    WR_PATCH_ERROR,   /* error against the reference */
    WR_PATCH_DROPPED, /* error of the small-F approximation, degrees */
    WR_PATCH_TILT,    /* angle between n and n', degrees */
    WR_PATCH_LEVEL,   /* mip level */
    WR_PATCH_HEIGHT,  /* F */
    WR_PATCH_NORMAL,  /* n', as a colour */
    /* error of bump mapping against displacement: outline red, shading green, shadow blue */
    WR_PATCH_LACKS,
    WR_PATCH_RAN, /* effect heatmap: the preview's own picture, as live as that */
    WR_PATCH_LOOKS
} WrPatchLook;
extern const char *const wr_patch_look_names[WR_PATCH_LOOKS]; /* display names */

/* A picture drawn over the patch. */
typedef struct WrPatchLayer {
    SDL_Texture *texture; /* owned */
    int width, height;    /* its size in pixels; 0: none */
    uint64_t of;          /* state of the document that it shows */
    int look;             /* for maps: the kind */
    double low, full;     /* values at the ends of the scale */
} WrPatchLayer;

typedef struct WrInspector {
    bool pinned; /* fixed at its position */
    bool have;   /* there is a position */
    bool on_table;
    double x, y; /* the position: fractions of the view; u, v of the patch */
    WrProbe probe;
    char object[64];   /* name of the object if there are several, else "" */
    bool known, seen;  /* probe is valid; see WrWork.seen */
    uint64_t asked_of; /* state of the last request */
    bool asked_table;
    double asked_x, asked_y;
    bool copied; /* the values were copied to the clipboard */
} WrInspector;

typedef struct WrCases { /* hard-case gallery */
    char filter[80];
    const WrHardCase *chosen; /* NULL: none */
    WrHardReport *report;     /* owned; NULL: not measured yet */
    bool wanted;              /* to be measured when no other work runs */
} WrCases;

typedef struct WrStudy { /* tour of the cost of accuracy */
    int step;            /* 1 ..; 0: no tour */
    bool taken;          /* B has the setting of the step */
    WrPatchLook look;    /* before the tour ... */
    double b[WR_DIAL_COUNT];
    bool b_given;
} WrStudy;

struct WrAccuracy {
    /* shared, owned: content of the view */
    WrField *field; /* shared, owned */
    WrTables *tables;
    WrScene *scene;
    double turn_deg;
    int width, height;
    uint64_t state;             /* counter of view states */
    double changed_at;          /* clock */
    bool error_open, plot_open; /* they were visible in the last frame */

    WrWorkTools measure_tools, look_tools, probe_tools;
    WrJob *measure, *looker, *prober;
    bool measuring;      /* a measurement is running ... */
    WrWorkKind measures; /* ... of this kind */

    WrWork *error;     /* newest result, owned; NULL: none */
    uint64_t error_of; /* state that was measured, or whose measurement failed */
    WrError error_why; /* reason of a failure; "" */
    WrWork *plot;      /* newest benchmark, owned; NULL: none */
    char *plot_base;   /* the benchmark's scene without its dials, owned */
    uint64_t plot_key; /* key of its table and of the picture's rotation */
    double plot_turn;
    uint64_t plot_failed; /* state whose benchmark failed */
    uint64_t fits_of;     /* state for which the next two members are valid; 0: none */
    bool fits;            /* the plot belongs to this table and scene, except for the dials */
    int rung;             /* index of the rung with the scene's dials, -1: none */
    bool plot_asked;
    WrWork *illusion;     /* newest result, owned; NULL: none */
    bool illusion_wanted; /* to be measured when no other work runs */
    int plot_hot;         /* point under the pointer, -1: none */

    WrPatchLook look;
    double split; /* fraction of the view left of the divider */
    bool hold_b;  /* the key that shows B is held */
    SDL_Keycode hold_key;
    double flicker_since;
    bool flicker_shown; /* the last frame showed B */
    int chooses;        /* side that the dials and the plot change: 0 A, 1 B */
    double b[WR_DIAL_COUNT];
    bool b_given;
    uint64_t b_serial, look_serial; /* version of B's dials: present, and of the last request */
    uint64_t look_of; /* state for which pictures or a map were requested, or failed */
    int look_kind;
    WrPatchLayer pair[2], map;

    WrPreviewPicture full_times; /* times and size of the preview's last full-quality picture */
    WrInspector inspector;
    WrCases cases;
    WrStudy study;
};

/* Kind of reference map for a patch picture. */
WrProbeMap wr_accuracy_map_of(WrPatchLook look);

/* ---- accuracy_input.c ---- */
void wr_accuracy_panel_new(WrApp *app);
void wr_accuracy_free(WrApp *app);
/* True if a measurement is running or due; alternating pictures do not count. */
bool wr_accuracy_pending(const WrApp *app);
/* clock of the next necessary update; 0: only after events */
bool wr_accuracy_rests(const WrApp *app); /* nothing is dragged, drawn or rotating */
/* True if there is a benchmark for the table and the scene, except for the dials. */
bool wr_accuracy_plot_fits(const WrApp *app);
/* The rung with the scene's dials in a fitting benchmark, or -1. */
int wr_accuracy_current_rung(const WrApp *app);
bool wr_accuracy_busy(WrApp *app, WrWorkKind kind, double *fraction);

/* ---- dials of A, changed by commands, and of B ---- */
/* A's dial: the scene's; B's: the last choice, initially the best. */
double wr_accuracy_dial(const WrApp *app, int side, int dial);
void wr_accuracy_set_dial(WrApp *app, int side, int dial, double value);
/* Set all dials to those of a benchmark rung. */
void wr_accuracy_take_rung(WrApp *app, int side, int rung);
void wr_accuracy_b_from_a(WrApp *app);
void wr_accuracy_swap_ab(WrApp *app);
/* The scene with the dials of A or B, without tolerance. The caller frees it. */
WrScene *wr_accuracy_scene(const WrApp *app, int side);
/* Make the finest dials chosen by the tolerance the scene's dials, and remove the tolerance. */
void wr_accuracy_keep(WrApp *app);
/* Short description of A's or B's dials. */
void wr_accuracy_dials_text(const WrApp *app, int side, WrText *text);

/* ---- accuracy_view.c: over the patch ---- */
void wr_accuracy_set_view(WrApp *app, WrPatchLook look);
void wr_accuracy_draw(WrApp *app);    /* pictures over the preview */
void wr_accuracy_overlay(WrApp *app); /* labels, divider, scale */
/* the pointer can grasp the divider */
bool wr_accuracy_on_line(const WrApp *app, double x, double y);
void wr_accuracy_drag_line(WrApp *app, double x);
/* Convert a finished picture or map to a texture. */
void wr_accuracy_lay(WrApp *app, const WrWork *work);

/* ---- panels ---- */
void wr_panel_accuracy(WrApp *app);
void wr_panel_illusion(WrApp *app);
void wr_panel_study(WrApp *app);
void wr_panel_inspector(WrApp *app);
void wr_inspector_follow(WrApp *app); /* update its position, before each frame */
void wr_dialog_cases(WrApp *app);
void wr_dialog_cases_open(WrApp *app);

/* ---- actions_accuracy.c ---- */
void wr_act_accuracy(WrApp *app);
void wr_act_inspector(WrApp *app);
void wr_act_inspector_pin(WrApp *app);
void wr_act_inspector_copy(WrApp *app);
void wr_act_display_plain(WrApp *app);
void wr_act_display_split(WrApp *app);
void wr_act_display_flicker(WrApp *app);
void wr_act_display_error(WrApp *app);
void wr_act_display_dropped(WrApp *app);
void wr_act_display_tilt(WrApp *app);
void wr_act_display_level(WrApp *app);
void wr_act_display_height(WrApp *app);
void wr_act_display_normal(WrApp *app);
void wr_act_display_ran(WrApp *app);
void wr_act_accuracy_measure(WrApp *app);
void wr_act_study(WrApp *app); /* panel_study.c */
bool wr_is_study(const WrApp *app);
void wr_act_compare_take(WrApp *app);
void wr_act_compare_swap(WrApp *app);
void wr_act_compare_hold(
    WrApp *app); /* modifier action: active while its key is held; from a menu it toggles */
bool wr_is_accuracy(const WrApp *app);
bool wr_is_inspector(const WrApp *app);
bool wr_is_inspector_pinned(const WrApp *app);
bool wr_is_display_plain(const WrApp *app);
bool wr_is_display_split(const WrApp *app);
bool wr_is_display_flicker(const WrApp *app);
bool wr_is_display_error(const WrApp *app);
bool wr_is_display_dropped(const WrApp *app);
bool wr_is_display_tilt(const WrApp *app);
bool wr_is_display_level(const WrApp *app);
bool wr_is_display_height(const WrApp *app);
bool wr_is_display_normal(const WrApp *app);
bool wr_is_display_ran(const WrApp *app);
bool wr_is_compare_hold(const WrApp *app);

extern const WrPart wr_part_accuracy;
