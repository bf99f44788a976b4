/* preview.h - asynchronous rendering of the patch from snapshots, so that strokes never wait for a picture: low
   quality during motion, then refined step by step in a static view.

   All calls except those of the thread itself are from the window's thread. */
#pragma once
#include "ui/patch/preview/moving.h"

#include "accuracy/tolerance.h"
#include "render/frame/frame.h"
#include "render/plan/effect_heatmap.h"
#include "render/plan/plan.h"
#include "scene/dials.h"

#include <SDL.h>
#include <stdbool.h>
#include <stdint.h>

typedef struct WrChosen {
    bool any; /* a tolerance chose this picture's dials */
    bool met;
    bool kept;                   /* they were stored in the document for this very picture */
    char reason[480];            /* one or two sentences */
    char line[80];               /* the dials that matter most: "exact bspline-fit 4x4" */
    double dials[WR_DIAL_COUNT]; /* by WrDialId */
} WrChosen;

void wr_choice_summary(const WrChoice *choice, WrChosen *out);

/* ---- preview ---- */

typedef struct WrError WrError;
typedef struct WrField WrField;
typedef struct WrScene WrScene;
typedef struct WrTables WrTables;

typedef struct WrPreview WrPreview;

/* Quality of the picture. */
typedef enum WrPreviewLevel {
    WR_PREVIEW_NONE,
    WR_PREVIEW_MOVING, /* adapted to 60 pictures per second (moving.h); fast arithmetic */
    WR_PREVIEW_FULL,   /* one sample per pixel, the scene's arithmetic */
    WR_PREVIEW_SMOOTH, /* 2 x 2 samples per pixel */
    /* 4 x 4, or more if the scene's dials require it; with a tolerance, the chosen dials */
    WR_PREVIEW_FINAL,
    WR_PREVIEW_LEVELS
} WrPreviewLevel;

/* threads: as in wr_pool_new. isa: as in wr_renderer_new. ready_event: an SDL event type, pushed when a picture or an
 * answer is ready. The thread starts with the first request. */
WrPreview *wr_preview_new(int threads, const char *isa, Uint32 ready_event);
/* Stops the thread and cancels its work. NULL is allowed. */
void wr_preview_free(WrPreview *preview);

/* View mode: changes to the display besides the scene. */
typedef struct WrPreviewLook {
    bool ran;        /* effect heatmap instead of the picture */
    bool marked;     /* stripes on over-exposed pixels */
    WrForce force;   /* force one effect off or on, for a comparison */
    WrEffect effect; /* that effect; ignored without force */
} WrPreviewLook;
bool wr_preview_look_same(const WrPreviewLook *a, const WrPreviewLook *b);

typedef struct WrPreviewRequest {
    const WrField *field; /* shared by the call, as is the scene */
    const WrScene *scene;
    const WrTables *tables; /* prepared tables of its objects; NULL: all use `field` */
    double turn_deg;
    int width, height; /* of the view, pixels */
    int64_t tag;       /* returned with the picture */
    const char *
        chosen; /* stored dials of the document for its tolerance; NULL: none; copied by the call */
    bool painting; /* edits follow in quick succession: prefer speed and do not refine */
    WrPreviewLook look;
    bool moving; /* further requests follow at once: do not go beyond WR_PREVIEW_MOVING */
} WrPreviewRequest;

/* Replace the request. A high-quality picture in progress for an older one is cancelled. */
void wr_preview_want(WrPreview *preview, const WrPreviewRequest *wish);

/* Request the (u,v) under a point of the view, as fractions of its width and height; outside 0..1: no request. The
 * answer is updated with every picture until another point is requested. */
void wr_preview_point(WrPreview *preview, double x, double y);
/* True if that point is on the object in the newest picture; returns its position. */
bool wr_preview_point_hit(WrPreview *preview, double *u, double *v);

/* A finished picture. */
typedef struct WrPreviewPicture {
    int width, height; /* pixels of bgra */
    uint8_t *bgra;     /* BGRA, [height][width][4] */
    WrPreviewLevel level;
    double turn_deg;
    double seconds; /* wall time, conversion included */
    WrStageTimes times;
    WrPlan plan;
    bool ran;               /* it is an effect heatmap, ... */
    WrHeatmapCounts counts; /* ... with these pixel counts */
    double clipped;         /* share of over-exposed pixels */
    WrChosen chosen;        /* dials chosen by the scene's tolerance */
    char *
        kept; /* their text form for the document (wr_choice_write); owned; NULL: nothing was chosen */
    WrMovingWay way;  /* mode of WR_PREVIEW_MOVING ... */
    double scale;     /* ... and its size relative to the view */
    int64_t tag;      /* from the request */
    uint64_t serial;  /* counter of pictures; 0: none yet */
    SDL_Rect changed; /* pixels outside are equal to the picture of serial `since` */
    uint64_t since;   /* an earlier delivered picture; 0: none, everything has changed */
} WrPreviewPicture;

/* ---- times of a picture ---- */
#define WR_PICTURE_STAGES 6 /* number of WrStageTimes */
extern const char *const wr_picture_stages[];
/* Wall time in milliseconds, distributed to the stages; shown in the status line, the Accuracy tab and the Plan
   tab. */
double wr_picture_time(const WrPreviewPicture *picture, double ms[WR_PICTURE_STAGES]);
/* Mode of a moving picture: "2 x 2", "1 x 1 at 60 %"; "" for others. */
#define WR_PICTURE_MOVING 40
void wr_picture_moving(const WrPreviewPicture *picture, char text[WR_PICTURE_MOVING]);
/* The mode in a sentence with its meaning. */
#define WR_PICTURE_WORDS 200
void wr_picture_words(const WrPreviewPicture *picture, char text[WR_PICTURE_WORDS]);

/* ---- queries of a preview ---- */
/* The newest finished picture; unchanged until the next call. */
const WrPreviewPicture *wr_preview_picture(WrPreview *preview);
/* True if the thread has finished the present request. */
bool wr_preview_settled(WrPreview *preview);
/* The error since the last call; false: none. */
bool wr_preview_error(WrPreview *preview, WrError *err);
