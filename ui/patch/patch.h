/* patch.h - the patch's view: what is wished of the preview and when, turning, the light, the camera. */
#pragma once
#include "ui/state/app_state.h"
#include "ui/state/roster.h"
#include "ui/patch/patch_cube.h"
#include "ui/patch/patch_objects.h"
#include "ui/preview/preview.h"
#include "ui/preview/rotation.h"

#include "document/object_tables.h"
#include "scene/camera.h"

#include <SDL.h>
#include <stdbool.h>
#include <stdint.h>

typedef struct WrField WrField;
typedef struct WrPointer WrPointer;
typedef struct WrScene WrScene;

/* What was done to the view while a command ran. */
typedef enum WrPatchLate {
    WR_PATCH_NOTHING,
    WR_PATCH_HELD,   /* it is held still */
    WR_PATCH_CAMERA, /* app->live has another camera, */
    WR_PATCH_TURNED  /* or another turn of the object: a command afterwards */
} WrPatchLate;

typedef struct WrPatch {
    SDL_Texture *texture; /* of the newest picture; owned */
    int texture_w, texture_h;
    uint64_t serial;       /* of that picture */
    int64_t seen;          /* pointer events that it shows (latency.c) */
    double turn_deg;       /* 0..360 */
    double rock;           /* where a rocking sheet is on its way, radians (rotation.h) */
    WrScene *rock_scene;   /* own share of the scene of which this is known: */
    bool rocks;            /* a whole turn would show backs (scene/backface_range.h) */
    double turned_at;      /* clock at the last step of the turn */
    WrField *wished_field; /* own shares of what was wished for last */
    WrTables *wished_tables;
    WrTableCache table_cache;
    WrScene *wished_scene;
    double wished_turn;
    int wished_w, wished_h;
    bool wished_moving, wished_painted;
    WrPreviewLook look, wished_look;
    double clipped;   /* their share of the picture that is shown */
    bool refreshing;  /* sharp pictures are being brought up to date by an edit */
    bool outstanding; /* a moving picture was wished for and has not come */
    bool held;        /* it stands still to be painted on */
    double wished_at, rest_at;
    double still_since;
    /* of a drag */
    WrRotation from; /* the object's own rotation at the start */
    WrVec3 from_at;  /* its place and size there */
    double from_size;
    WrVec3 from_sizes;
    WrCamera from_camera; /* and the camera, its eye where it stood */
    WrHandle handle;      /* of the chosen object */
    bool pans;            /* the drag moves the camera sideways */
    bool rounds;          /* it moves it round its target */
    int light;            /* index of the light being moved */
    double light_x, light_y;
    double from_turn;      /* of the surroundings, when they were taken */
    double zoom_commit_at; /* clock at which a zoom by the wheel becomes a command; 0: none */
    bool zoom_angle;       /* it is of the angle of view */
    WrPatchCube cube;
    WrPatchLate meanwhile;
} WrPatch;

void wr_patch_update(WrApp *app); /* wish for what is wanted; take what is ready */
void wr_patch_draw(WrApp *app);
void wr_patch_overlay(WrApp *app);
void wr_patch_draw_lights(const WrApp *app);
/* Turning by hand, moving a light, the wheel. press: false where there is nothing to hold. */
bool wr_patch_press(WrApp *app, const WrPointer *at);
void wr_patch_drag(WrApp *app, const WrPointer *at);
void wr_patch_release(WrApp *app);
void wr_patch_wheel(WrApp *app, double steps);
void wr_patch_wheel_angle(WrApp *app, double steps); /* the camera's, in place of its distance */
/* A zoom by the wheel that waits becomes a command; now false: it is forgotten. */
void wr_patch_commit_zoom(WrApp *app, bool now);
/* The camera, or the object's turn, as it stands in the live scene, becomes a command. */
void wr_patch_commit_camera(WrApp *app);
void wr_patch_commit_turn(WrApp *app);
/* patch_meanwhile.c: an event while a command runs, true if it was for looking at the patch; and when that is done. */
bool wr_patch_look(WrApp *app, const SDL_Event *event);
void wr_patch_commit_late(WrApp *app);
/* Where its camera stands, as the patch is turned now. False: there is none, or no room. */
bool wr_patch_place(const WrApp *app, WrPlacement *out);
void wr_patch_free(WrApp *app);
double wr_patch_next_time(const WrApp *app); /* clock at which update must run; 0: only on events */
bool wr_patch_paints(const WrApp *app);      /* the pointer over the patch would paint */
/* The orientation cube or a lamp lies there, over the object: a press is for it, though the patch is painted on. */
bool wr_patch_control_under(const WrApp *app, const WrPointer *at);

extern const WrPart wr_part_patch;
