/* SPDX-License-Identifier: MIT */
/*
 * Questions of pairs, in tasks. What a task finds stays with its worker. Which worker has asked what changes nothing
 * but where an answer stands.
 */
#ifndef PIR_SCENE_ANSWER_ASK_H
#define PIR_SCENE_ANSWER_ASK_H

#include "scene/world/scene.h"

/* Asks all of scene->lists.asked. Errors: those of a query of a pair; the one of the first question that failed. */
pir_status pir_scene_ask(pir_scene *scene);

#endif
