/* surface_list.h - the list of all surfaces: a new one needs its file and its two lines here.

   With WR_X(name) defined it expands to the names; with WR_SURFACE_FORMULAS defined it includes the
   formulas (see precision.h). */
#ifdef WR_X
WR_X(plane)
WR_X(bent)
WR_X(curl)
WR_X(bezier)
WR_X(sphere)
WR_X(cylinder)
WR_X(cone)
WR_X(torus)
WR_X(cube)
WR_X(ribbon)
WR_X(disc)
WR_X(capsule)
WR_X(superellipsoid)
WR_X(revolution)
WR_X(formula)
WR_X(mesh)
WR_X(patches)
WR_X(terrain)
#undef WR_X
#endif
#ifdef WR_SURFACE_FORMULAS
#include "surface/frame.h"
#include "surface/plane.h"
#include "surface/bent.h"
#include "surface/curl.h"
#include "surface/bezier.h"
#include "surface/sphere.h"
#include "surface/cylinder.h"
#include "surface/cone.h"
#include "surface/torus.h"
#include "surface/cube.h"
#include "surface/ribbon.h"
#include "surface/disc.h"
#include "surface/capsule.h"
#include "surface/superellipsoid.h"
#include "surface/revolution.h"
#include "surface/equation.h"
#include "surface/mesh.h"
#include "surface/patches_row.h"
#include "surface/terrain_row.h"
#endif
