/* patch.h - the patch view: requests to the preview and their timing, rotation, lights, camera. */
#pragma once
#include "ui/app/state/app_state.h"
#include "ui/app/state/registry.h"
#include "ui/patch/patch_cube.h"
#include "ui/patch/patch_objects.h"
#include "ui/patch/preview/preview.h"
#include "ui/patch/preview/rotation.h"

#include "document/object_tables.h"
#include "scene/camera.h"
#include "surface/projection.h"

#include <SDL.h>
#include <stdbool.h>
#include <stdint.h>

typedef struct WrField WrField;
typedef struct WrGrip WrGrip;
typedef struct WrPointer WrPointer;
typedef struct WrScene WrScene;

/* Changes of the view while a command runs. */
typedef enum WrPatchLate {
    WR_PATCH_NOTHING,
    WR_PATCH_HELD,   /* the view is dragged */
    WR_PATCH_CAMERA, /* app->live has another camera, */
    WR_PATCH_TURNED  /* or another rotation of the object: to be run as a command afterwards */
} WrPatchLate;

typedef struct WrPatch {
    SDL_Texture *texture; /* of the newest picture; owned */
    int texture_w, texture_h;
    uint64_t serial;       /* serial number of that picture */
    int64_t seen;          /* number of pointer events that it shows (latency.c) */
    double turn_deg;       /* 0..360 */
    double rock;           /* phase of the rocking, radians (rotation.h) */
    WrScene *rock_scene;   /* scene for which `rocks` was computed; shared, owned: */
    bool rocks;            /* a full rotation would show backs (scene/backface_range.h) */
    double turned_at;      /* clock at the last rotation step */
    WrField *wished_field; /* table of the last request; shared, owned */
    WrTables *wished_tables;
    WrTableCache table_cache;
    WrScene *wished_scene;
    double wished_turn;
    int wished_w, wished_h;
    bool wished_moving, wished_painted;
    WrPreviewLook look, wished_look;
    double clipped;   /* share of over-exposed pixels in the displayed picture */
    bool refreshing;  /* full-quality pictures are being updated after an edit */
    bool outstanding; /* a requested moving picture has not arrived */
    bool held;        /* rotation is paused for painting */
    double wished_at, rest_at;
    /* for a drag */
    WrRotation from; /* the object's own rotation at the start */
    WrVec3 from_at;  /* its position and size at the start */
    double from_size;
    WrVec3 from_sizes;
    WrCamera from_camera; /* camera at the start */
    WrHandle handle;      /* dragged handle of the active object, or of its projection */
    WrProjection from_projection;
    bool projecting; /* the projection's handle is on */
    bool pans;       /* the drag pans the camera */
    bool rounds;     /* the drag orbits the camera around its target */
    int light;       /* index of the dragged light */
    double light_x, light_y;
    double from_turn;      /* environment rotation at the start */
    double zoom_commit_at; /* clock at which a wheel zoom becomes a command; 0: none */
    bool zoom_angle;       /* the zoom changes the angle of view, */
    bool zoom_moves;       /* or also the camera's target or direction */
    WrPatchCube cube;
    WrPatchLate meanwhile;
} WrPatch;

void wr_patch_overlay(WrApp *app);
void wr_patch_draw_lights(const WrApp *app);
/* Rotation by the pointer, dragging of a light, wheel zoom. press: false if there is nothing to drag. */
bool wr_patch_press(WrApp *app, const WrPointer *at);
void wr_patch_drag(WrApp *app, const WrPointer *at);
void wr_patch_release(WrApp *app);
void wr_patch_wheel(WrApp *app, double steps);
/* Two fingers: zoom; pan, or orbit the camera while one finger paints. */
void wr_patch_grip(WrApp *app, const WrGrip *grip);
/* zoom by the angle of view instead of the distance */
void wr_patch_wheel_angle(WrApp *app, double steps);
/* Run a pending wheel zoom as a command; now false: discard it. */
void wr_patch_commit_zoom(WrApp *app, bool now);
/* Run the camera, or the object's rotation, of the live scene as a command. */
void wr_viewport_commit_camera(WrApp *app);
void wr_patch_commit_turn(WrApp *app);
/* Handle an event while a command runs, true if it moved the view; and at the end of the
   command. */
bool wr_patch_view_event(WrApp *app, const SDL_Event *event);
void wr_patch_commit_late(WrApp *app);
/* Placement of the camera for the displayed rotation. False: there is no camera, or no room. */
bool wr_patch_place(const WrApp *app, WrPlacement *out);
void wr_patch_free(WrApp *app);
/* clock of the next necessary update; 0: only after events */
double wr_patch_next_time(const WrApp *app);
bool wr_patch_paints(const WrApp *app); /* painting on the patch is active at the pointer */
/* True if the orientation cube or a light is under the pointer, over the object: a press then drags it even in
   painting mode. */
bool wr_patch_control_under(const WrApp *app, const WrPointer *at);

extern const WrPart wr_part_patch;
