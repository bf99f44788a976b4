/* scene.h - scene description: surface, bump, material, lights, camera, dials.

   Everything that a picture depends on besides the height table; plain data with defaults and checks. A
   scene may contain several objects (objects.h). The members of an object here (surface to position)
   are those of the active one, to which commands apply; the others are scenes of one object each. A
   shared scene is immutable: edits clone it (wr_scene_clone), so a snapshot is one pointer. World space
   is right-handed, y up; colours are linear; angles here in degrees. */
#pragma once
#include "base/vec.h"
#include "field/analytic.h"
#include "field/scheme.h"
#include "scene/background.h"
#include "scene/camera.h"
#include "scene/height_colormap.h"
#include "scene/dials.h"
#include "scene/environment.h"
#include "scene/normal_map_frame.h"
#include "scene/export_settings.h"
#include "scene/tone_mapping.h"
#include "shade/bump_mode.h"
#include "shade/environment_brdf.h"
#include "shade/solid_texture.h"
#include "shade/reflection.h"
#include "surface/projection.h"
#include "surface/surface.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct WrError WrError;
typedef struct WrField WrField;
typedef struct WrImage WrImage;
typedef struct WrTriangles WrTriangles;

typedef enum WrLightKind { WR_LIGHT_DIRECTIONAL, WR_LIGHT_POINT, WR_LIGHT_KINDS } WrLightKind;
typedef struct WrLightKindInfo {
    const char *name;  /* as in commands */
    const char *label; /* in the window, English */
    const char *help;
    bool placed; /* WrLight.where is a position, else a direction */
} WrLightKindInfo;
extern const WrLightKindInfo wr_light_kinds[WR_LIGHT_KINDS];

typedef struct WrLight {
    WrLightKind kind;
    WrVec3 where;  /* a position, or the direction from the surface TO the light, any length > 0 */
    WrVec3 colour; /* linear RGB, 0..1e6 */
    double strength; /* 0..1e6; the light's L is colour * strength */
    double size_deg; /* 0..45: angular radius of a round lamp, for shadows; 0: a point */
    bool shadow;     /* it casts shadows between objects and on themselves */
} WrLight;

typedef struct WrMaterial {
    double ambient, diffuse, specular; /* ka, kd, ks: 0..1000 */
    double shininess;                  /* s: 0..1e6 */
    WrVec3 colour;                     /* C, linear RGB; does not tint the highlight */
    bool gate;                         /* highlight only where n'.l > 0 */
    /* Reflection model (shade/reflection.h); it determines which of these numbers are used. */
    int model; /* WrReflect */
    WrEnergy energy;
    double roughness, metalness, ior;
    bool shadow;    /* the relief casts shadows on itself */
    bool occlusion; /* and occludes the sky */
    double tint;    /* fraction of the highlight with the surface's colour */
} WrMaterial;

/* Required accuracy of the picture; matching dials are found by measurement (accuracy/tolerance.h). */
typedef enum WrToleranceKind {
    WR_TOLERANCE_NONE, /* the dials are used as set */
    WR_TOLERANCE_RMS,  /* of linear intensity over the covered pixels, maximum */
    WR_TOLERANCE_MAX,  /* for any channel of any pixel */
    WR_TOLERANCE_TIME, /* seconds per frame: the smallest error within that time */
    WR_TOLERANCE_COUNT
} WrToleranceKind;
/* As in commands: "off", "rms", "max", "time". */
extern const char *const wr_tolerance_names[WR_TOLERANCE_COUNT];

typedef struct WrTolerance {
    WrToleranceKind kind;
    double value; /* linear intensity 0..1e6, or seconds 1e-4..3600 */
} WrTolerance;

/* Source of a picture mapped over u and v, and its repetition. */
typedef struct WrTextureSample {
    char *path;           /* path from the command; owned; NULL if none */
    char *channel, *part; /* requested channel and part of the file; owned */
    char sha256[65];
    bool own; /* it has its own repetition, in the next two; else that of the table */
    double ru, rv;
} WrTextureSample;

/* An object's normal map. */
typedef struct WrNormalMap {
    /* Shared; NULL: none. Three channels, unit vectors. In tangent space: x along u, y along v, z > 0;
       else along the object's axes. */
    WrImage *image;
    WrTextureSample laid;
    int channels;        /* channels read from the file: 2 or 3 */
    bool green_down;     /* the file's second number was inverted */
    bool object;         /* in the object's axes; else in tangent space, in that frame */
    WrNormalFrame frame; /* for tangent space */
    double strength;     /* -100..100: factor of its slopes */
    WrCombine combine;   /* with the relief */
} WrNormalMap;

/* Maps of facet properties. */
typedef enum WrFacetKind { WR_FACET_ROUGHNESS, WR_FACET_METALNESS, WR_FACET_KINDS } WrFacetKind;
typedef struct WrFacetMap {
    WrImage *image; /* shared; one channel, 0..1; NULL: the material's number everywhere */
    WrTextureSample laid;
} WrFacetMap;

/* Real size of the unit cell, used by exports, solids and labels, not by pictures. */
typedef struct WrCellSize {
    double w, h; /* above 0: scene units, or millimetres */
    bool mm;
    double height; /* millimetres for F = 1; in scene units that is the scene's `height` */
} WrCellSize;

struct WrScene {
    int refs;          /* atomic; private to scene.c */
    WrShape shape;     /* its data is shared: set by wr_scene_set_shape */
    bool posed;        /* rotate was given; else the surface's own pose is used */
    WrVec3 rotate_deg; /* about the world's x, then y, then z */
    WrBumpMode bump;
    WrScheme scheme;
    double height;  /* scene units per table unit; any finite value */
    bool displaced; /* F displaces the surface itself, P + F n; else only its normal */
    bool parallax;  /* rays continue from the base to F above it; not needed if displaced */
    double replicate_u, replicate_v;
    WrAnalytic analytic; /* replaces the table while its kind is not OFF; terms owned */
    WrMaterial material;
    WrSolidTexture grain; /* solid texture of the object */
    WrImage *colour;      /* C(u,v), shared, linear RGB in 0..; NULL: the material's colour alone */
    WrTextureSample colour_laid;
    WrHeightColormap colouring; /* source of that picture, if computed (its path is NULL then) */
    WrNormalMap normals;
    WrFacetMap facets[WR_FACET_KINDS];
    /* For a shape that is a mesh (wr_scene_set_triangles): */
    WrTriangles *triangles; /* shared; NULL: the square of two triangles (wr_triangles_square) */
    char *triangles_path;   /* as WrTextureSample's */
    char triangles_sha256[65];
    WrTriangles
        *mesh_source; /* shared; the file's mesh, from which `triangles` is derived; NULL: itself */
    WrProjection projection; /* of kind `uv` for other surfaces */
    char
        *form_layer; /* for a terrain: the document's layer with its heights; owned; NULL: a file */
    uint64_t form_key; /* key of those heights when the triangles were computed (wr_layer_key) */
    char *
        mask_layer; /* for a mesh: the document's layer that limits the relief; owned; NULL: none */
    WrField *mask;  /* its table, when the triangles were derived; shared; NULL: none */
    uint64_t mask_key; /* key of that table (wr_layer_key) */
    char *name;        /* of the object; owned; NULL: none */
    WrVec3 at;         /* position of the object's centre, world; within 1e9 */
    double size;       /* world units per unit of the object, 1e-9..1e9; the largest of `sizes` */
    /* Sizes along the object's axes, if they differ or are not above 0; the largest magnitude is
       1e-9..1e9. 0,0,0: `size` along all. */
    WrVec3 sizes;
    bool hidden;      /* not in pictures */
    bool still;       /* excluded from the turntable and from fitting: a floor */
    char *layer;      /* of the document, whose heights are its table; owned; NULL: all layers */
    WrScene **others; /* [other_count], owned shares: the other objects, in order */
    int other_count;
    int chosen;        /* index of the active one among all: 0..other_count */
    bool lights_given; /* false: `lights` contains the default light */
    WrLight *lights;   /* [light_count], owned */
    int light_count;
    WrCamera camera;
    WrNamedView *views; /* [view_count], owned; in order of creation */
    int view_count;
    WrDials dials;
    WrTolerance tolerance;
    WrBackground background;
    WrEnvironment environment;
    WrTone tone;
    WrCellSize cell;
    WrSheetRequest sheet; /* only for the window */
    double radius;        /* cached radius of the shape, for members of `others`; private */
};

/* Sets the scene's triangles, which it owns; NULL: any other shape, or the square. The shape keeps its
 * kind if that uses triangles, else it becomes a mesh. path and sha256 may be NULL. */
void wr_scene_set_triangles(WrScene *scene, WrTriangles *triangles, const char *path,
                            const char *sha256);
/* The mesh of the file, before projections, tiles and masks; borrowed; NULL: none. */
const WrTriangles *wr_scene_mesh_source(const WrScene *scene);
/* Derives the scene's triangles, of kind mesh, anew from those of its file, with the scene's mask. Errors:
 * wr_triangles_project. */
bool wr_scene_project(WrScene *scene, const WrProjection *projection, WrError *err);
/* Sets the layer that limits the relief, and its table; the triangles are derived anew by wr_scene_project alone. Either may
 * be NULL. */
void wr_scene_set_mask(WrScene *scene, const char *layer, const WrField *mask, uint64_t key);
/* The object's mesh with the (u,v) of all its tiles; a reference. Errors: wr_triangles_project. */
WrTriangles *wr_scene_whole_mesh(const WrScene *scene, WrError *err);
/* True if the projection, the tile, the unit or the origin differ from those of a file of this name alone. */
bool wr_scene_projected(const WrScene *scene);
/* Converts the meshes of the scene's objects to one picture of one channel, the storage format of
 * documents; and restores that of an object. The caller owns both; *out is NULL if there is none.
 * Errors: not a picture of meshes; out of memory. */
bool wr_scene_meshes_to_image(const WrScene *scene, WrImage **out, WrError *err);
WrTriangles *wr_scene_mesh_from_image(const WrImage *image, int object, WrError *err);
bool wr_scene_several_meshes(const WrScene *scene); /* true if objects have different meshes */

size_t wr_scene_mesh_bytes(const WrTriangles *triangles); /* memory in bytes */

bool wr_cell_size_given(const WrCellSize *cell); /* true if not 1,1 scene units */
double wr_scene_relief(const WrScene *scene); /* height of F = 1 in the unit of the cell's size */

WrSceneView wr_scene_view(const WrScene *scene);
void wr_scene_set_pose(WrScene *scene, const WrSceneView *view);

/* The scene of an empty document: the unit plane facing the viewer, blinn / central, one light from the
   upper left. The caller owns it. */
WrScene *wr_scene_new(void);
/* A deep copy that the caller may modify until it is shared. */
WrScene *wr_scene_clone(const WrScene *scene);
WrScene *wr_scene_share(const WrScene *scene); /* constant time */
/* Copies the settings shared by all objects, from lights to surroundings, to a modifiable scene. */
void wr_scene_take_shared(WrScene *scene, const WrScene *from);
void wr_scene_free(WrScene *scene);
/* True if both, of one object each, have the same points with the same normals, for any light, material
   and dials. The caller must hold references to both, so that equal addresses mean equal content. */
bool wr_scene_same_normals(const WrScene *a, const WrScene *b);
/* Sets a shape; shares its borrowed data. */
void wr_scene_set_shape(WrScene *scene, const WrShape *shape);

/* removes the colour picture and its colormap */
void wr_scene_drop_colour(WrScene *scene);
void wr_texture_sample_fini(WrTextureSample *laid); /* frees its members and resets it */
/* Repetition of a scene's picture over u and v. */
void wr_scene_repeat(const WrScene *scene, const WrTextureSample *laid, double *ru, double *rv);

/* Depth of the near plane before the eye, in radii of the object. */
#define WR_NEAR_PLANE 1e-10

/* Minimum thickness of an object relative to its largest size: replaces a size of 0 along an axis. */
#define WR_THINNEST 0x1p-16
/* True if it is thinner along one axis than a 32nd of another. */
bool wr_scene_is_thin(const WrScene *scene);

/* Transforms for a picture. The world position of a point of the object is
 *
 *   position + size * rotation * stretch (P - centre),   rotation = Ry(turn_deg) Rz Ry Rx
 *
 * (pose, then the turntable, which rotates all objects about the world's y axis), stretch by factors
 * along the object's axes, of which the largest is 1.
 *
 * A normal n of the object becomes `cofactor` n, component-wise, not unit: it stays on its side, also
 * for a mirrored object (HC153). */
typedef struct WrPlacement {
    /* Row-major object -> world, orthonormal: computed from angles each time, so it cannot drift
       (HC88). */
    double rotation[9];
    WrVec3 centre;   /* object point that is mapped to `position` */
    WrVec3 position; /* world */
    double size;     /* world units per unit of the object */
    bool stretched;  /* else stretch and cofactor are 1,1,1 */
    WrVec3 stretch, cofactor;
    WrVec3 eye; /* world; computed if `fit` */
    /* World; orthonormal, right x up = -forward: the camera looks down its own -Z. */
    WrVec3 right, up, forward;
    double half_height; /* tan(fov/2), or size/2, times `widen`; half the width is this times the
                        aspect */
    double widen;       /* factor for the camera's frame in a narrower picture; 1: none */
    bool orthographic;
    double radius; /* of the object about its centre, in its units */
    double ball;   /* of all objects about the world's origin (objects.h) */
    double reach;  /* of all objects including displacement */
} WrPlacement;

/* Stretch and cofactor of the object, independent of the camera. */
void wr_scene_stretch(const WrScene *scene, WrVec3 *stretch, WrVec3 *cofactor);

/* The placement for a picture `aspect` times as wide as high, after a turn about the world's y.
 *
 * turn_deg   any finite value; whole turns are subtracted exactly (HC87)
 * fit        the eye is placed at a distance from the target such that the sphere about the target
 *            which contains the objects' spheres keeps a few percent from the picture's nearer pair of
 *            borders, for every turn; and displacements stay within the picture
 * up         if it is 0 or parallel to the view, another axis replaces it
 * Errors     eye = target; an angle, position, field of view or aspect that is not finite or out of
 *            range */
bool wr_scene_place(const WrScene *scene, double turn_deg, double aspect, WrPlacement *out,
                    WrError *err);
/* wr_scene_place with a known radius of the shape (wr_shape_radius), whose computation dominates for
 * free forms. */
bool wr_scene_place_with_radius(const WrScene *scene, double radius, double turn_deg, double aspect,
                                WrPlacement *out, WrError *err);

/* Transforms a point from the object to the world, and back. */
WrVec3 wr_object_to_world(const WrPlacement *place, WrVec3 p);
WrVec3 wr_world_to_object(const WrPlacement *place, WrVec3 world);
/* Rotates a direction of the world to the object's axes; preserves its length. */
WrVec3 wr_place_turn_back(const WrPlacement *place, WrVec3 world);
/* Inverse transforms of directions to the unstretched object: the direction that becomes `world` when
 * stretched; and the covector whose product with a point is that of `world` with the stretched point. */
WrVec3 wr_place_shrink_back(const WrPlacement *place, WrVec3 world);
WrVec3 wr_place_dual_back(const WrPlacement *place, WrVec3 world);

/* F = height * table(ru u, rv v) and its derivatives with respect to the PATCH parameters, in double,
 * from the table or the analytic function (field may then be NULL). On a periodic axis ru u is reduced
 * to 0..1; on a clamped one it is not: beyond the table's ends F is constant and its slope 0, so that a
 * clamped table appears once for any replication. Outputs may be NULL, are finite, and include the
 * factors height, height ru, height rv. */
void wr_scene_height(const WrScene *scene, const WrField *field, double u, double v, double *f,
                     double *fu, double *fv);
/* Only F at `count` positions, with the same bits. Runs of up to WR_HEIGHTS_RUN are the fastest. */
#define WR_HEIGHTS_RUN 256
void wr_scene_heights(const WrScene *scene, const WrField *field, int count, const double *u,
                      const double *v, double *f);
/* F at a place of a face, of a mesh with weights (relief_weights.h): b1, b2 of its corners 1 and 2; and its slopes by
 * the face's own u and v. */
void wr_scene_weighted_height(const WrScene *scene, const WrField *field, const WrTriangles *mesh,
                              int32_t face, double b1, double b2, double *f, double *fu,
                              double *fv);

/* Coefficients of a material's formulas. */
void wr_scene_matter(const WrMaterial *material, WrMatter *matter);
WrReflectance wr_scene_reflectance(const WrMaterial *material);
/* Its reflection of surroundings. */
void wr_scene_gloss(const WrMaterial *material, WrEnvironmentBrdf *gloss);
