/* app_state.h - state of the window: pointers to the state of each component. The members are defined in the header
   of each component; include it where they are used. */
#pragma once
#include <SDL.h>
#include <stdbool.h>
#include <stdint.h>

typedef struct WrApp WrApp;
typedef struct WrAccuracy WrAccuracy;
typedef struct WrAction WrAction;
typedef struct WrAdjust WrAdjust;
typedef struct WrAppOptions WrAppOptions;
typedef struct WrBrushState WrBrushState;
typedef struct WrBrushSources WrBrushSources;
typedef struct WrBusy WrBusy;
typedef struct WrCanvas WrCanvas;
typedef struct WrCanvasMap WrCanvasMap;
typedef struct WrCanvasRange WrCanvasRange;
typedef struct WrCanvasView WrCanvasView;
typedef struct WrChosenLayers WrChosenLayers;
typedef struct WrCloneState WrCloneState;
typedef struct WrDialogState WrDialogState;
typedef struct WrDocument WrDocument;
typedef struct WrDocumentState WrDocumentState;
typedef struct WrDrawState WrDrawState;
typedef struct WrDroppedFiles WrDroppedFiles;
typedef struct WrFiles WrFiles;
typedef struct WrFinder WrFinder;
typedef struct WrPreferences WrPreferences;
typedef struct WrForms WrForms;
typedef struct WrGenerateState WrGenerateState;
typedef struct WrGui WrGui;
typedef struct WrGuide WrGuide;
typedef struct WrHistoryState WrHistoryState;
typedef struct WrInputRouter WrInputRouter;
typedef struct WrKeyMap WrKeyMap;
typedef struct WrLatency WrLatency;
typedef struct WrDeferred WrDeferred;
typedef struct WrLayerPlanState WrLayerPlanState;
typedef struct WrLayersState WrLayersState;
typedef struct WrLayout WrLayout;
typedef struct WrMarks WrMarks;
typedef struct WrMessages WrMessages;
typedef struct WrMeter WrMeter;
typedef struct WrOutlineRequest WrOutlineRequest;
typedef struct WrPart WrPart;
typedef struct WrPatch WrPatch;
typedef struct WrPatchPaint WrPatchPaint;
typedef struct WrPen WrPen;
typedef struct WrPointer WrPointer;
typedef struct WrPreview WrPreview;
typedef struct WrRecovery WrRecovery;
typedef struct WrReplace WrReplace;
typedef struct WrIdleProbe WrIdleProbe;
typedef struct WrRegistry WrRegistry;
typedef struct WrScene WrScene;
typedef struct WrSeamMeter WrSeamMeter;
typedef struct WrSelectState WrSelectState;
typedef struct WrSession WrSession;
typedef struct WrSettings WrSettings;
typedef struct WrSheetState WrSheetState;
typedef struct WrPresetBrowser WrPresetBrowser;
typedef struct WrStampState WrStampState;
typedef struct WrSurfaceState WrSurfaceState;
typedef struct WrObjectsState WrObjectsState;
typedef struct WrDynamics WrDynamics;
typedef struct WrTester WrTester;
typedef struct WrTiming WrTiming;
typedef struct WrTool WrTool;
typedef struct WrTransformState WrTransformState;
typedef struct WrEditPreview WrEditPreview;
typedef struct WrWaits WrWaits;

/* State of the window, which owns the pointed-to objects unless stated otherwise. Lengths are pixels of the window,
   times seconds of system/clock.h. */
struct WrApp {
    const WrRegistry *registry;  /* borrowed: lists of the window's components */
    const WrAppOptions *options; /* borrowed */
    WrSession *session;          /* borrowed; a snapshot while a command runs in the background */
    SDL_Window *window;
    SDL_Renderer *renderer;
    WrGui *gui;
    WrCanvas *canvas;
    WrCanvasMap *canvas_map;    /* map shown instead of the heights */
    WrCanvasMap *canvas_second; /* second component of a map with two: slopes along v */
    WrPreview *preview;
    WrKeyMap *keys;
    WrPen *pen;
    WrTester *tester;     /* tablet tester; owned, NULL until it is opened */
    WrDynamics *dynamics; /* curve editor of the brush; owned, NULL until it is opened */
    WrGuide *guide;       /* help browser; owned, NULL until it is opened */
    WrSettings *settings;
    WrSettings *settings_known; /* last state read from or written to the file */
    double settings_at;         /* clock of the last comparison with it */
    bool settings_failed;       /* the last write failed */
    WrFiles *files;
    Uint32 ready_event; /* SDL event type: preview finished */
    Uint32 file_event;  /* SDL event type: native file dialog closed */
    Uint32 job_event;   /* SDL event type: background job finished */
    WrIdleProbe *rest;  /* test probe for idle periods; owned, or NULL */
    Uint32 rest_event;  /* SDL event type of the probe */
    SDL_Cursor *cursors[SDL_NUM_SYSTEM_CURSORS];
    SDL_SystemCursor cursor;

    WrLayout *layout;
    int width, height, menu_height;
    double display_scale; /* scale of the display, in steps of 1/4 */
    const char *
        display_word; /* reason for the choice of that display and its effect on pens; NULL: no remark */
    bool fitted;      /* the window was shown to the user: its size is no longer adjusted */
    int redraw;       /* frames still to draw */
    bool visible, quit;
    double drawn_at, started_at;
    double draw_seconds; /* duration of the last frame */
    double drawn_scale;
    WrTiming *timing;

    WrCanvasView *view;
    bool view_placed;
    WrCanvasRange *range;     /* range of heights on the canvas */
    WrCanvasRange *map_range; /* range of the map shown instead of the heights */
    bool map_shown;
    double pins_height; /* of the pinned rows in the last frame, pixels */
    int torn_tab;    /* 1 + index of the tab that the pointer has just torn off its bar; 0: none */
    int tab_menu;    /* index of the tab with the open menu */
    bool mask_alone; /* show the active layer's mask on the canvas while edits go to it */
    bool canvas_unfinished;
    int tool;
    WrInputRouter *hand;
    WrBrushState *brush;
    WrBrushSources *brush_files;
    WrPresetBrowser *shelf;
    WrDrawState *draw;
    WrCloneState *clone;
    WrTransformState *transform;
    WrStampState *stamp;
    WrGenerateState *generate; /* owned */
    WrAccuracy *accuracy;      /* owned */
    WrPatch *patch;
    WrPatchPaint *paint;
    WrLatency *latency;        /* running latency measurement; borrowed */
    void (*drawn)(WrApp *app); /* called when a frame was shown; NULL: not needed */
    WrScene *live;             /* scene of the preview while a scene value is dragged; owned */
    bool hints;                /* start hints are shown until the first stroke */

    WrEditPreview *trial;
    bool trying; /* the views show the edit preview */
    WrMarks *marks;
    WrSelectState *select;
    WrDroppedFiles *dropped;
    struct SDL_Texture *dropped_picture; /* the first of them; owned */
    WrChosenLayers *chosen;              /* read by wr_app_chosen, which updates them */
    WrLayersState *layers;
    WrLayerPlanState *layer_plan;
    WrHistoryState *history;
    WrSurfaceState *surface;
    WrObjectsState *objects;
    WrSheetState *sheet; /* state of the export sheet; owned; NULL until it is opened */
    WrAdjust *adjust;
    WrOutlineRequest *selecting; /* state of the dialogs that change the selection */
    WrFinder *finder;
    WrPreferences *preferences;
    WrSeamMeter *seam_meter; /* owned; NULL until it is drawn */
    WrMeter *meter;
    WrDeferred *later;
    /* command running in the background (ui/app/state/background_command.h); owned, NULL: none */
    WrBusy *busy;
    WrWaits *waits;       /* actions queued behind it */
    bool gave_up;         /* the last background command was cancelled by the user */
    WrRecovery *recovery; /* while the recovery dialog is open; owned */
    bool in_frame;        /* between the first and the last widget of a frame */
    double input_at;      /* clock at the last user event */
    double thrifty_at;    /* clock of the last memory trim after an idle period */

    WrMessages *messages;
    WrDialogState *dialog;
    WrForms *forms;
    WrReplace *replace;
    WrDocumentState *file;
};

/* Request another frame. */
void wr_app_redraw(WrApp *app);
/* Compute app->layout from the present window size in pixels. */
void wr_app_make_layout(WrApp *app);
/* Pixels per widget unit, 0.75..3: from WRINKLE_SCALE, the setting, or the display. */
double wr_app_wanted_scale(const WrApp *app);
void wr_app_set_scale(WrApp *app, double setting); /* 0: the display's scale */
/* Load the key map: built-in keys, the chosen map, then the user's file; errors in that become a message. */
void wr_app_read_keys(WrApp *app);
