// SPDX-License-Identifier: MIT
// libccd: MPR for overlap and penetration, on supports by hill climbing of ours. It has no distance.
#include <ccd/ccd.h>

#include <pirouette/ccd.h>
#include <pirouette/query.h>

#include "peers.hpp"

namespace {

void support(const void *object, const ccd_vec3_t *direction, ccd_vec3_t *point) {
    pir_support_body_ccd(object, direction->v, point->v);
}

void centre(const void *object, ccd_vec3_t *point) {
    pir_vec3 t = static_cast<const pir_support_body *>(object)->translation;
    ccdVec3Set(point, t.x, t.y, t.z);
}

class Ccd : public Peer {
  public:
    Ccd(const pir_polytope *p, const pir_polytope *q, double tolerance) {
        p_ = {p, {0, 0, 0, 1}, {0, 0, 0}, 0};
        q_ = {q, {0, 0, 0, 1}, {0, 0, 0}, 0};
        CCD_INIT(&ccd_);
        ccd_.support1 = ccd_.support2 = support;
        ccd_.center1 = ccd_.center2 = centre;
        ccd_.max_iterations = 500;
        ccd_.mpr_tolerance = tolerance;
    }
    const char *name() const override {
        return "libccd";
    }
    void place(pir_quat r, pir_vec3 t) override {
        p_.rotation = r;
        p_.translation = t;
    }
    PeerAnswer ask(bool deep) override {
        PeerAnswer answer;
        if (!deep) {
            answer.overlaps = ccdMPRIntersect(&p_, &q_, &ccd_) != 0;
            return answer;
        }
        ccd_real_t depth;
        ccd_vec3_t direction, point;
        int found = ccdMPRPenetration(&p_, &q_, &ccd_, &depth, &direction, &point);
        answer.overlaps = found == 0;
        answer.has_distance = found == 0;
        answer.distance = -depth;
        answer.failed = found == -2;
        return answer;
    }

  private:
    ccd_t ccd_;
    pir_support_body p_, q_;
};

} // namespace

std::unique_ptr<Peer> make_ccd(const pir_polytope *p, const pir_polytope *q, double tolerance) {
    return std::make_unique<Ccd>(p, q, tolerance);
}
