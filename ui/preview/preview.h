/* preview.h - the patch, rendered by a thread of its own from snapshots, so that no stroke ever waits for
   a picture: coarse while something moves, then sharp step by step when it rests.

   All calls but those of the thread itself come from the window's thread. */
#pragma once
#include "ui/preview/accuracy_choice.h"
#include "ui/preview/moving.h"

#include "render/frame/frame.h"
#include "render/plan/plan.h"
#include "render/plan/effect_heatmap.h"

#include <SDL.h>
#include <stdbool.h>
#include <stdint.h>

typedef struct WrError WrError;
typedef struct WrField WrField;
typedef struct WrScene WrScene;
typedef struct WrTables WrTables;

typedef struct WrPreview WrPreview;

/* How good the picture is. */
typedef enum WrPreviewLevel {
    WR_PREVIEW_NONE,
    WR_PREVIEW_MOVING, /* as coarse as it takes for 60 pictures a second, or as fine as that allows (moving.h); fast
                          arithmetic */
    WR_PREVIEW_FULL,   /* every pixel once, the scene's arithmetic */
    WR_PREVIEW_SMOOTH, /* 2 x 2 samples a pixel */
    WR_PREVIEW_FINAL, /* 4 x 4, or more if the scene's dials say so; with a tolerance, what it chooses */
    WR_PREVIEW_LEVELS
} WrPreviewLevel;

/* threads: as in wr_pool_new. isa: as in wr_renderer_new. ready_event: an SDL event type, pushed
 * whenever a picture or an answer is there. The thread starts with the first wish. */
WrPreview *wr_preview_new(int threads, const char *isa, Uint32 ready_event);
/* Stops the thread, cancelling what it does. NULL is fine. */
void wr_preview_free(WrPreview *preview);

/* How a picture is shown, besides what the scene says. */
typedef struct WrPreviewLook {
    bool ran;        /* where each effect ran, in false colours, instead */
    bool marked;     /* pixels that are full in some colour are striped */
    WrForce force;   /* one effect is left out, or run though it need not: before and after */
    WrEffect effect; /* which; of no meaning without force */
} WrPreviewLook;
bool wr_preview_look_same(const WrPreviewLook *a, const WrPreviewLook *b);

typedef struct WrPreviewWish {
    const WrField *field; /* shared by the call, as is the scene */
    const WrScene *scene;
    const WrTables *tables; /* of its objects; NULL: `field` is that of all */
    double turn_deg;
    int width, height; /* of the view, pixels */
    int64_t tag;       /* comes back with the picture */
    const char *
        chosen; /* the dials that the document keeps for its tolerance; NULL: none; copied by the call */
    bool painting; /* edits follow one another: be quick rather than fine, and do not refine yet */
    WrPreviewLook look;
    bool moving; /* more wishes will follow at once: do not go beyond WR_PREVIEW_MOVING */
} WrPreviewWish;

/* Replace the wish. A sharp picture under way for an older one is given up. */
void wr_preview_want(WrPreview *preview, const WrPreviewWish *wish);

/* Ask for the (u,v) under a point of the view, as fractions of its width and height; outside 0..1: ask
 * for nothing. The answer follows every picture until another point is asked for. */
void wr_preview_point(WrPreview *preview, double x, double y);
/* True if that point lies on the object in the newest picture, and where. */
bool wr_preview_point_hit(WrPreview *preview, double *u, double *v);

/* A finished picture. */
typedef struct WrPreviewPicture {
    int width, height; /* pixels of bgra */
    uint8_t *bgra;     /* [height][width][4] */
    WrPreviewLevel level;
    double turn_deg;
    double seconds; /* wall time, conversion included */
    WrStageTimes times;
    WrPlan plan;
    bool ran;               /* it shows where each effect ran, ... */
    WrHeatmapCounts counts; /* ... on so many pixels */
    double clipped;         /* share of its pixels that are full in some colour */
    WrChosen chosen;        /* what the scene's tolerance chose for it */
    char *
        kept; /* the same as the document keeps it (wr_choice_write); owned; NULL: nothing was chosen */
    WrMovingWay way;  /* of WR_PREVIEW_MOVING ... */
    double scale;     /* ... and its size beside the view's */
    int64_t tag;      /* of the wish that it shows */
    uint64_t serial;  /* counts pictures; 0: none yet */
    SDL_Rect changed; /* pixels beyond it are as in the picture of serial `since` */
    uint64_t since;   /* handed over before this one; 0: there is none such, all is changed */
} WrPreviewPicture;

/* ---- picture_time.c ---- */
#define WR_PICTURE_STAGES 6 /* of WrStageTimes */
extern const char *const wr_picture_stages[];
/* Milliseconds that it took by the clock, and each stage's share of them: the figure of the status line, the
   Accuracy tab and the Plan tab. */
double wr_picture_time(const WrPreviewPicture *picture, double ms[WR_PICTURE_STAGES]);
/* Of a picture made while something moves: "2 x 2", "1 x 1 at 60 %"; "" of others. */
#define WR_PICTURE_MOVING 40
void wr_picture_moving(const WrPreviewPicture *picture, char text[WR_PICTURE_MOVING]);
/* The same in a sentence, with what it counts. */
#define WR_PICTURE_WORDS 200
void wr_picture_words(const WrPreviewPicture *picture, char text[WR_PICTURE_WORDS]);

/* ---- of a preview ---- */
/* The newest finished picture; stays as it is until the next call. */
const WrPreviewPicture *wr_preview_picture(WrPreview *preview);
/* The thread has nothing left to do for the present wish. */
bool wr_preview_settled(WrPreview *preview);
/* What went wrong since the last call, or false. */
bool wr_preview_error(WrPreview *preview, WrError *err);
