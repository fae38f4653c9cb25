/* SPDX-License-Identifier: MIT */
/**
 * All of libpirouette but exact.h, which shows GMP types, and cglm.h, which shows those of cglm. The libraries beside
 * it have headers of their own: cspace.h and grid.h are libpirouette-cspace's, ccd.h is libpirouette-ccd's.
 */
#ifndef PIROUETTE_H
#define PIROUETTE_H

#include <pirouette/base.h>
#include <pirouette/body_shape.h>
#include <pirouette/certificate.h>
#include <pirouette/cgm.h>
#include <pirouette/clash.h>
#include <pirouette/critical.h>
#include <pirouette/events.h>
#include <pirouette/gradient.h>
#include <pirouette/history.h>
#include <pirouette/impact.h>
#include <pirouette/io.h>
#include <pirouette/live_mesh.h>
#include <pirouette/mass.h>
#include <pirouette/mesh.h>
#include <pirouette/motion.h>
#include <pirouette/pair.h>
#include <pirouette/pair_batch.h>
#include <pirouette/plan.h>
#include <pirouette/polytope.h>
#include <pirouette/pose.h>
#include <pirouette/query.h>
#include <pirouette/scene.h>
#include <pirouette/scene_draw.h>
#include <pirouette/scene_file.h>
#include <pirouette/scene_query.h>
#include <pirouette/section.h>
#include <pirouette/shape.h>
#include <pirouette/simplify.h>
#include <pirouette/solid.h>
#include <pirouette/solid_batch.h>
#include <pirouette/solid_contact.h>
#include <pirouette/solid_query.h>
#include <pirouette/sum.h>
#include <pirouette/sweep.h>
#include <pirouette/tasks.h>
#include <pirouette/trimesh.h>
#include <pirouette/trimesh_batch.h>
#include <pirouette/trimesh_contact.h>
#include <pirouette/trimesh_pair.h>
#include <pirouette/version.h>
#include <pirouette/witness.h>
#include <pirouette/workspace.h>

#endif
