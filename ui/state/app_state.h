/* app_state.h - the window's state: where everything lies. Each subject's own header says what lies there; who needs it
   includes that. */
#pragma once
#include <SDL.h>
#include <stdbool.h>
#include <stdint.h>

typedef struct WrApp WrApp;
typedef struct WrAccuracy WrAccuracy;
typedef struct WrAction WrAction;
typedef struct WrAdjust WrAdjust;
typedef struct WrAppOptions WrAppOptions;
typedef struct WrBrushHand WrBrushHand;
typedef struct WrBrushSources WrBrushSources;
typedef struct WrBusy WrBusy;
typedef struct WrCanvas WrCanvas;
typedef struct WrCanvasMap WrCanvasMap;
typedef struct WrCanvasRange WrCanvasRange;
typedef struct WrCanvasView WrCanvasView;
typedef struct WrCertificate WrCertificate;
typedef struct WrCloneHand WrCloneHand;
typedef struct WrDialogHand WrDialogHand;
typedef struct WrDocument WrDocument;
typedef struct WrDocumentHand WrDocumentHand;
typedef struct WrDrawHand WrDrawHand;
typedef struct WrFiles WrFiles;
typedef struct WrFinder WrFinder;
typedef struct WrPreferences WrPreferences;
typedef struct WrForms WrForms;
typedef struct WrGenerateHand WrGenerateHand;
typedef struct WrGui WrGui;
typedef struct WrGuide WrGuide;
typedef struct WrHand WrHand;
typedef struct WrKeyMap WrKeyMap;
typedef struct WrLatency WrLatency;
typedef struct WrDeferred WrDeferred;
typedef struct WrLayersHand WrLayersHand;
typedef struct WrLayout WrLayout;
typedef struct WrMarks WrMarks;
typedef struct WrMessages WrMessages;
typedef struct WrMeter WrMeter;
typedef struct WrOutlineAsk WrOutlineAsk;
typedef struct WrPart WrPart;
typedef struct WrPatch WrPatch;
typedef struct WrPatchPaint WrPatchPaint;
typedef struct WrPen WrPen;
typedef struct WrPointer WrPointer;
typedef struct WrPresetTiles WrPresetTiles;
typedef struct WrPreview WrPreview;
typedef struct WrRecovery WrRecovery;
typedef struct WrReplace WrReplace;
typedef struct WrIdleProbe WrIdleProbe;
typedef struct WrRoster WrRoster;
typedef struct WrScene WrScene;
typedef struct WrSeam WrSeam;
typedef struct WrSelectHand WrSelectHand;
typedef struct WrSession WrSession;
typedef struct WrSettings WrSettings;
typedef struct WrSheetState WrSheetState;
typedef struct WrPresetBrowser WrPresetBrowser;
typedef struct WrStampHand WrStampHand;
typedef struct WrSurfaceHand WrSurfaceHand;
typedef struct WrObjectsHand WrObjectsHand;
typedef struct WrDynamics WrDynamics;
typedef struct WrTester WrTester;
typedef struct WrTiming WrTiming;
typedef struct WrTool WrTool;
typedef struct WrTransformHand WrTransformHand;
typedef struct WrEditPreview WrEditPreview;
typedef struct WrWaits WrWaits;

/* The window owns what these point to unless they say otherwise. Lengths are pixels of the window, times seconds of
   system/clock.h. */
struct WrApp {
    const WrRoster *roster;      /* borrowed: what the window is made of */
    const WrAppOptions *options; /* borrowed */
    WrSession *session; /* borrowed; while something runs beside the window, a still of it */
    SDL_Window *window;
    SDL_Renderer *renderer;
    WrGui *gui;
    WrCanvas *canvas;
    WrCanvasMap *canvas_map;    /* shown in the table's place */
    WrCanvasMap *canvas_second; /* with it, where it takes two: slopes along v */
    WrPreview *preview;
    WrKeyMap *keys;
    WrPen *pen;
    WrTester *tester;     /* of tablets; owned, NULL until it is opened */
    WrDynamics *dynamics; /* the same of the brush's curves */
    WrGuide *guide;       /* the help; owned, NULL until it is opened */
    WrSettings *settings;
    WrSettings *settings_known; /* as they were read or written last */
    double settings_at;         /* clock when they were looked at last */
    bool settings_failed;       /* and could not be written then */
    WrFiles *files;
    Uint32 ready_event; /* of the preview */
    Uint32 file_event;  /* of a native file dialog */
    Uint32 job_event;   /* of work in the background */
    WrIdleProbe *rest;  /* a test that asks; owned, or NULL */
    Uint32 rest_event;  /* it asked */
    SDL_Cursor *cursors[SDL_NUM_SYSTEM_CURSORS];
    SDL_SystemCursor cursor;

    WrLayout *layout;
    int width, height, menu_height;
    double display_scale; /* of the display, in steps of 1/4 */
    const char *
        display_word; /* why it is on that display, and what that means for pens; NULL: nothing to say */
    bool fitted;      /* the user has seen the window: its size is left alone */
    int redraw;       /* pictures of the window still to draw */
    bool visible, quit;
    double drawn_at, started_at;
    double drawn_scale;
    WrTiming *timing;

    WrCanvasView *view;
    bool view_placed;
    WrCanvasRange *range;     /* heights that the canvas shows */
    WrCanvasRange *map_range; /* numbers of the map that it shows in their place */
    bool map_shown;
    bool mask_alone; /* the canvas shows the active layer's mask, as long as edits go there */
    bool canvas_unfinished;
    int tool;
    WrHand *hand;
    WrBrushHand *brush;
    WrBrushSources *brush_files;
    WrPresetBrowser *shelf;
    WrDrawHand *draw;
    WrCloneHand *clone;
    WrTransformHand *transform;
    WrStampHand *stamp;
    WrGenerateHand *generate; /* owned */
    WrAccuracy *accuracy;     /* owned */
    WrPatch *patch;
    WrPatchPaint *paint;
    WrLatency *latency;        /* while it is being measured; borrowed */
    void (*drawn)(WrApp *app); /* a picture of the window was shown; NULL: nobody asks */
    WrScene *live; /* what the preview shows while a scene value is being dragged; owned */
    bool hints;    /* shown until the first stroke */

    WrEditPreview *trial;
    bool trying; /* the views show what the trial gives */
    WrMarks *marks;
    WrSelectHand *select;
    WrLayersHand *layers;
    WrSurfaceHand *surface;
    WrObjectsHand *objects;
    WrSheetState *sheet;    /* of the export sheet; owned; NULL until it is opened */
    WrPresetTiles *presets; /* owned; NULL until their list is drawn */
    WrAdjust *adjust;
    WrOutlineAsk *selecting; /* of the dialogs that change the selection */
    WrFinder *finder;
    WrPreferences *preferences;
    WrSeam *seam;
    WrCertificate *certificate;
    uint64_t seam_key; /* of the table and the scheme that both were measured on */
    WrMeter *meter;
    WrDeferred *later;
    WrBusy *busy;         /* what runs beside the window (ui/state/busy.h); owned, NULL: nothing */
    WrWaits *waits;       /* and what waits for it */
    bool gave_up;         /* the newest of them failed because the user cancelled it */
    WrRecovery *recovery; /* while its dialog is open; owned */
    bool in_frame;        /* between the first and the last widget of a picture */
    double input_at;      /* clock at the last event of the user's */
    double thrifty_at;    /* clock when memory was given back because there was none for a while */

    WrMessages *messages;
    WrDialogHand *dialog;
    WrForms *forms;
    WrReplace *replace;
    WrDocumentHand *file;
};

/* Another picture of the window is due. */
void wr_app_redraw(WrApp *app);
/* app->layout by the window's size in pixels, as it is now. */
void wr_app_make_layout(WrApp *app);
/* Pixels a unit of the widgets, 0.75..3: WRINKLE_SCALE, the setting, or the display's. */
double wr_app_wanted_scale(const WrApp *app);
void wr_app_set_scale(WrApp *app, double setting); /* 0: the display's */
/* Built in, the chosen map, the user's file; what is wrong there becomes a message. */
void wr_app_read_keys(WrApp *app);
