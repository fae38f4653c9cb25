// SPDX-License-Identifier: MIT
// Ours: a pir_scene with manifolds, told of the bodies that moved. What overlaps is what its events say.
#include <cstdio>
#include <cstdlib>
#include <set>

#include "scene_peers.hpp"

namespace {

void check(pir_status status) {
    if (status != PIR_OK) {
        std::fprintf(stderr, "bench_scene: %s\n", pir_status_text(status));
        std::exit(2);
    }
}

class Ours : public ScenePeer {
  public:
    Ours(const Recording &recording, uint32_t threads, double reuse) : name_("ours") {
        if (threads > 1)
            name_ += ", " + std::to_string(threads) + " threads";
        if (reuse > 0)
            name_ += " reusing manifolds";
        pir_scene_options options = pir_scene_options_default();
        options.threads = threads;
        options.reuse = reuse;
        check(pir_scene_create(&options, &scene_));
        for (const RecordedBody &body : recording.statics)
            add(body.polytope, body.pose, PIR_BODY_STATIC);
        statics_ = (uint32_t)recording.statics.size();
        for (size_t i = 0; i < recording.bodies.size(); i++)
            add(recording.bodies[i].polytope, recording.frames[0][i], PIR_BODY_MOVING);
    }
    ~Ours() override {
        pir_scene_destroy(scene_);
    }
    const char *name() const override {
        return name_.c_str();
    }
    void set(const std::vector<uint32_t> &moved, const std::vector<pir_pose> &poses) override {
        moves_.clear();
        for (uint32_t i : moved)
            moves_.push_back({statics_ + i, poses[i]});
        check(pir_scene_update(scene_, moves_.data(), moves_.size()));
        size_t count;
        const pir_scene_event *event = pir_scene_events(scene_, &count);
        for (size_t i = 0; i < count; i++) {
            BodyPair pair{event[i].body_p, event[i].body_q};
            if (event[i].kind == PIR_EVENT_BEGAN)
                began_.push_back(pair);
            else if (event[i].kind == PIR_EVENT_ENDED)
                ended_.push_back(pair);
        }
    }
    void overlapping(std::vector<BodyPair> *ret_pairs) override {
        contacts_.insert(began_.begin(), began_.end());
        for (const BodyPair &pair : ended_)
            contacts_.erase(pair);
        began_.clear();
        ended_.clear();
        ret_pairs->assign(contacts_.begin(), contacts_.end());
    }
    size_t bytes() const override {
        return pir_scene_get_statistics(scene_).peak;
    }

  private:
    void add(pir_polytope *polytope, const pir_pose &pose, pir_body_kind kind) {
        pir_body_options body = pir_body_options_default();
        uint32_t id;
        body.kind = kind;
        body.pose = pose;
        body.pieces = &polytope;
        body.piece_count = 1;
        check(pir_scene_add(scene_, &body, &id));
    }

    std::string name_;
    pir_scene *scene_ = nullptr;
    uint32_t statics_;
    std::vector<pir_scene_move> moves_;
    std::vector<BodyPair> began_, ended_;
    std::set<BodyPair> contacts_;
};

} // namespace

std::unique_ptr<ScenePeer> make_our_scene(const Recording &recording, uint32_t threads, double reuse) {
    return std::make_unique<Ours>(recording, threads, reuse);
}
