/* SPDX-License-Identifier: MIT */
/*
 * Questions of pairs, in tasks. What a task finds stays with its worker. Which worker has asked what changes nothing
 * but where an answer stands.
 */
#ifndef PIR_SCENE_ANSWER_ASK_H
#define PIR_SCENE_ANSWER_ASK_H

#include "scene/world/scene.h"

/* Distances are asked for up to this part of the bodies' size: what is farther apart is not looked at for a while. */
#define PIR_SKIN 0.05

/* Keeps that the bodies of a pair, in their places, are as far apart, but for what distances in doubles are off by. */
void pir_scene_keep_apart(pir_scene_pair *pair, const pir_scene_body *p, const pir_scene_body *q, double distance);

/* Asks all of scene->lists.asked. Errors: those of a query of a pair; the one of the first question that failed. */
pir_status pir_scene_ask(pir_scene *scene);

#endif
