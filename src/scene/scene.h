/* scene.h - all that a picture of a table depends on besides the table: surface, bump, material,
   lights, camera, dials. Plain data with defaults and checks.
   A scene may hold several objects (objects.h). What stands here of one (surface to place) is of the one at
   hand, which commands act on; the others are scenes of one object each.
   A scene that is shared is never written to: edits clone it (wr_scene_clone), so a
   snapshot is one pointer. World space is right-handed, y up; colours are linear; angles here in
   degrees. */
#pragma once
#include "base/vec.h"
#include "field/analytic.h"
#include "field/scheme.h"
#include "scene/background.h"
#include "scene/camera.h"
#include "scene/height_colormap.h"
#include "scene/dials.h"
#include "scene/environment.h"
#include "scene/normal_frame.h"
#include "scene/export_settings.h"
#include "scene/tone_mapping.h"
#include "shade/bump_mode.h"
#include "shade/environment_brdf.h"
#include "shade/solid_texture.h"
#include "shade/reflection.h"
#include "surface/surface.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct WrError WrError;
typedef struct WrField WrField;
typedef struct WrImage WrImage;
typedef struct WrTriangles WrTriangles;

typedef enum WrLightKind { WR_LIGHT_DIRECTIONAL, WR_LIGHT_POINT, WR_LIGHT_KINDS } WrLightKind;
/* As in commands: "directional", "point". */
extern const char *const wr_light_names[WR_LIGHT_KINDS];

typedef struct WrLight {
    WrLightKind kind;
    WrVec3 where;  /* directional: from the surface TO the light, any length > 0; point: position */
    WrVec3 colour; /* linear RGB, 0..1e6 */
    double strength; /* 0..1e6; the light's L is colour * strength */
    double size_deg; /* 0..45: angular radius of a round lamp, for shadows; 0: a point */
    bool shadow;     /* objects hide it from one another and from themselves */
} WrLight;

typedef struct WrMaterial {
    double ambient, diffuse, specular; /* ka, kd, ks: 0..1000 */
    double shininess;                  /* s: 0..1e6 */
    WrVec3 colour;                     /* C, linear RGB; does not tint the highlight */
    bool gate;                         /* highlight only where n'.l > 0 */
    /* How the two are formed (shade/reflection.h); of these numbers the model's own count. */
    int model; /* WrReflect */
    WrEnergy energy;
    double roughness, metalness, ior;
    bool shadow;    /* the relief hides lamps from itself */
    bool occlusion; /* and the sky from itself */
    double tint;    /* share of the highlight that has the surface's colour */
} WrMaterial;

/* What the picture must keep to; the dials that meet it are chosen by measuring (accuracy/tolerance.h). */
typedef enum WrToleranceKind {
    WR_TOLERANCE_NONE, /* the dials hold as they are set */
    WR_TOLERANCE_RMS,  /* of linear intensity over the covered pixels, at most */
    WR_TOLERANCE_MAX,  /* of any channel of any pixel */
    WR_TOLERANCE_TIME, /* seconds a frame: the least error that it buys */
    WR_TOLERANCE_COUNT
} WrToleranceKind;
/* As in commands: "off", "rms", "max", "time". */
extern const char *const wr_tolerance_names[WR_TOLERANCE_COUNT];

typedef struct WrTolerance {
    WrToleranceKind kind;
    double value; /* linear intensity 0..1e6, or seconds 1e-4..3600 */
} WrTolerance;

/* Where a picture that is laid over u and v is from, and how often it is laid. */
typedef struct WrTextureSample {
    char *path;           /* as the command named it; owned; NULL without */
    char *channel, *part; /* of the file that were asked for, likewise */
    char sha256[65];
    bool own; /* it is laid as often as the next say; else as often as the table */
    double ru, rv;
} WrTextureSample;

/* A normal map on the object. */
typedef struct WrNormalMap {
    /* Shared; NULL: there is none. Three channels, unit vectors. Of the tangent plane: x along u, y along v, z > 0;
       else along the object's axes. */
    WrImage *image;
    WrTextureSample laid;
    int channels;        /* of the file that were read: 2 or 3 */
    bool green_down;     /* the file's second number ran against v */
    bool object;         /* of the object's axes; else of the tangent plane, in that frame */
    WrNormalFrame frame; /* of the tangent plane */
    double strength;     /* -100..100: its slopes' factor */
} WrNormalMap;

/* Pictures of what facets are like from place to place. */
typedef enum WrFacetKind { WR_FACET_ROUGHNESS, WR_FACET_METALNESS, WR_FACET_KINDS } WrFacetKind;
typedef struct WrFacetMap {
    WrImage *image; /* shared; one channel, 0..1; NULL: the material's number holds everywhere */
    WrTextureSample laid;
} WrFacetMap;

/* How large the unit cell is for other programs: what exports, solids and labels go by. Pictures do not. */
typedef struct WrCellSize {
    double w, h; /* above 0: scene units, or millimetres */
    bool mm;
    double height; /* millimetres of F = 1; in scene units that is the scene's `height` */
} WrCellSize;

struct WrScene {
    int refs;          /* atomic; private to scene.c */
    WrShape shape;     /* its data is shared with it: set by wr_scene_set_shape */
    bool posed;        /* rotate was given; else the surface's own pose holds */
    WrVec3 rotate_deg; /* about the world's x, then y, then z */
    WrBumpMode bump;
    WrScheme scheme;
    double height;  /* scene units per table unit; any finite value */
    bool displaced; /* F moves the surface itself, P + F n; else its normal alone */
    bool parallax;  /* rays go on from the base to F over it; where it is displaced they need not */
    double replicate_u, replicate_v;
    WrAnalytic analytic; /* replaces the table while its kind is not OFF; terms owned */
    WrMaterial material;
    WrSolidTexture grain; /* the solid texture that it is cut out of */
    WrImage *colour;      /* C(u,v), shared, linear RGB in 0..; NULL: the material's colour alone */
    WrTextureSample colour_laid;
    WrHeightColormap colouring; /* what that is made by, if by any (its path is NULL then) */
    WrNormalMap normals;
    WrFacetMap facets[WR_FACET_KINDS];
    /* Of a shape that is a mesh (wr_scene_set_triangles): */
    WrTriangles *triangles; /* shared; NULL: the square of two (wr_triangles_square) */
    char *triangles_path;   /* as WrTextureSample's */
    char triangles_sha256[65];
    char *
        form_layer; /* of a terrain: the document's layer whose heights it has; owned; NULL: a file's */
    uint64_t form_key; /* of those heights when the triangles were made (wr_layer_key) */
    char *name;        /* of the object; owned; NULL: it was given none */
    WrVec3 at;         /* where the object's centre stands, world; within 1e9 */
    double size;       /* world units per unit of the object, 1e-9..1e9; of `sizes` the largest */
    /* Along the object's axes, where they differ or are not above 0; the largest magnitude is 1e-9..1e9. 0,0,0: `size`
       along all. */
    WrVec3 sizes;
    bool hidden; /* not in pictures */
    bool still;  /* the turntable leaves it, and a camera that fits does not mind it: a floor */
    char *layer; /* of the document, whose heights are its table; owned; NULL: all layers' */
    WrScene **others; /* [other_count], owned shares: the other objects, in their order */
    int other_count;
    int chosen;        /* place of the one at hand among all: 0..other_count */
    bool lights_given; /* false: `lights` holds the one default light */
    WrLight *lights;   /* [light_count], owned */
    int light_count;
    WrCamera camera;
    WrNamedView *views; /* [view_count], owned; in the order in which they were named */
    int view_count;
    WrDials dials;
    WrTolerance tolerance;
    WrBackground background;
    WrEnvironment environment;
    WrTone tone;
    WrCellSize cell;
    WrSheetAsk sheet; /* for the window alone */
    double radius;    /* of the shape, once it was found, of one of `others`; private */
};

/* The scene's surface becomes these triangles, which are taken over; NULL: any other shape, or the square. The shape stays
 * of its kind if that is one that holds such, else it becomes a mesh. path and sha256
 * may be NULL. */
void wr_scene_set_triangles(WrScene *scene, WrTriangles *triangles, const char *path,
                            const char *sha256);
/* The meshes of the scene's objects as one picture of one channel, in which a document keeps them, and that of an object
 * back. The caller owns both; *out is NULL where there is none. Errors: a picture that holds no mesh; no memory. */
bool wr_scene_meshes_to_image(const WrScene *scene, WrImage **out, WrError *err);
WrTriangles *wr_scene_mesh_from_image(const WrImage *image, int object, WrError *err);
bool wr_scene_several_meshes(const WrScene *scene); /* do objects have different ones? */

size_t wr_scene_mesh_bytes(const WrTriangles *triangles); /* that it takes in memory */

bool wr_cell_size_given(const WrCellSize *cell); /* other than 1,1 scene units */
double wr_scene_relief(const WrScene *scene); /* height of F = 1 in the unit of the cell's size */

WrSceneView wr_scene_view(const WrScene *scene);
void wr_scene_set_view(WrScene *scene, const WrSceneView *view);

/* The scene of an empty document: the unit plane facing the viewer, blinn / central, one light from
   the upper left. The caller owns it. */
WrScene *wr_scene_new(void);
/* A deep copy that the caller may change until it shares it. */
WrScene *wr_scene_clone(const WrScene *scene);
WrScene *wr_scene_share(const WrScene *scene); /* constant time */
/* What all objects have in common, lights to surroundings, from another scene: for one that may be changed. */
void wr_scene_take_shared(WrScene *scene, const WrScene *from);
void wr_scene_free(WrScene *scene);
/* Do both, of one object each, show the same points with the same normals, whatever their light, material and dials? Both
   are held by the caller, so that what they share is the same where it is at one address. */
bool wr_scene_same_normals(const WrScene *a, const WrScene *b);
/* Take a shape; what it borrows is shared from now on. */
void wr_scene_set_shape(WrScene *scene, const WrShape *shape);

void wr_scene_drop_colour(WrScene *scene);          /* no colour picture, and no colouring */
void wr_texture_sample_fini(WrTextureSample *laid); /* frees what it owns; it is none then */
/* How often a picture of the scene is laid over u and v. */
void wr_scene_repeat(const WrScene *scene, const WrTextureSample *laid, double *ru, double *rv);

/* The near plane's depth before the eye, in radii of the object: what lies nearer is not seen. */
#define WR_NEAR_PLANE 1e-10

/* No thinner is an object than this part of its largest size: a size of 0 along an axis counts as that. */
#define WR_THINNEST 0x1p-16
/* Is it thinner along one axis than a 32nd of another? */
bool wr_scene_is_thin(const WrScene *scene);

/* Where things are for a picture. A point of the object stands in the world at
 *   position + size * rotation * stretch (P - centre),   rotation = Ry(turn_deg) Rz Ry Rx  (pose, then the turntable, which
 *   turns all objects about the world's y axis), stretch by numbers along the object's axes, of which the largest is 1.
 * A normal n of the object is `cofactor` n there, number by number, not unit: it keeps to the side that it was on, also
 * of an object that is mirrored (HC153). */
typedef struct WrPlacement {
    /* Row-major object -> world, orthonormal: rebuilt from angles each time, so it cannot drift
       (HC88). */
    double rotation[9];
    WrVec3 centre;   /* object point that stands at `position` */
    WrVec3 position; /* world */
    double size;     /* world units per unit of the object */
    bool stretched;  /* else stretch and cofactor are 1,1,1 */
    WrVec3 stretch, cofactor;
    WrVec3 eye; /* world; with `fit` resolved */
    /* World; orthonormal, right x up = -forward: the camera looks down its own -Z. */
    WrVec3 right, up, forward;
    double
        half_height; /* tan(fov/2), or size/2, times `widen`; half the width is this times the aspect */
    double widen; /* for the camera's frame, in a narrower picture; 1: not needed */
    bool orthographic;
    double radius; /* of the object about its centre, in its units */
    double ball;   /* of all objects about the world's origin (objects.h) */
    double reach;  /* of the same as they are displaced (wr_scene_stands_out) */
} WrPlacement;

/* Those two of the object, whatever the camera. */
void wr_scene_stretch(const WrScene *scene, WrVec3 *stretch, WrVec3 *cofactor);

/* The placement for a picture `aspect` times as wide as high, after a turn about the world's y.
 *
 * turn_deg   any finite value; whole turns are taken off exactly (HC87)
 * fit        the eye stands so far from the target that the ball about the target which holds the
 *            objects' balls keeps a few percent from the picture's nearer pair of borders, however they turn; and
 *            that what is displaced stays within it
 * up         where it is 0 or along the view, another axis takes its place
 * Errors     eye = target; an angle, position, field of view or aspect that is no number or out of
 *            range */
bool wr_scene_place(const WrScene *scene, double turn_deg, double aspect, WrPlacement *out,
                    WrError *err);
/* The same where the shape's radius (wr_shape_radius) is known: that of a free form takes longer than all else. */
bool wr_scene_place_sized(const WrScene *scene, double radius, double turn_deg, double aspect,
                          WrPlacement *out, WrError *err);

/* A point of the object in the world, and back. */
WrVec3 wr_place_world(const WrPlacement *place, WrVec3 p);
WrVec3 wr_place_object(const WrPlacement *place, WrVec3 world);
/* A direction of the world along the object's axes; its length stays. */
WrVec3 wr_place_turn_back(const WrPlacement *place, WrVec3 world);
/* The same of the unstretched object: what becomes the direction when it is stretched; and of what is multiplied with
 * points: its product with the point is that of `world` with the stretched one. */
WrVec3 wr_place_shrink_back(const WrPlacement *place, WrVec3 world);
WrVec3 wr_place_dual_back(const WrPlacement *place, WrVec3 world);

/* F = height * table(ru u, rv v) and its derivatives with respect to the PATCH parameters, in
 * double, from the table or the analytic function (field may then be NULL). On a periodic axis ru
 * u is brought to 0..1; on a clamped one it is not: beyond the table's ends F is constant and its
 * slope 0, so that a clamped table appears once whatever the replication. Outputs may be NULL, are
 * finite, and carry the factors height, height ru, height rv. */
void wr_scene_height(const WrScene *scene, const WrField *field, double u, double v, double *f,
                     double *fu, double *fv);
/* F alone at `count` places, with the same bits. */
#define WR_HEIGHTS_RUN 256
void wr_scene_heights(const WrScene *scene, const WrField *field, int count, const double *u,
                      const double *v, double *f);

/* What a material's formulas go by. */
void wr_scene_matter(const WrMaterial *material, WrMatter *matter);
WrReflectance wr_scene_reflectance(const WrMaterial *material);
/* What it does with surroundings. */
void wr_scene_gloss(const WrMaterial *material, WrEnvironmentBrdf *gloss);
