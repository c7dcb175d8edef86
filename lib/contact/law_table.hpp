#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "bodies/model.hpp"
#include "contact/contact_law.hpp"

namespace pliant {

/// Contact laws between bodies. The rule of each pair of groups is found once per scene; bodies of a group share kind,
/// material and name in rules. The law itself also depends on both outline spacings and is made together with the pair.
class LawTable {
 public:
  /// Stiffness `auto`: kn = kt = 8 E/h, E of the softer compliant body, h the finer outline spacing; pairs of rigid
  /// bodies get three times the scene's largest. g_max `auto`: 0.12 h. Throws InputError for a missing rule or value,
  /// and for restitution where a compliant body takes part.
  explicit LawTable(const Model& model);

  /// Law at a given time: a body with a prescribed motion at that time counts as infinitely heavy for dashpots.
  ContactLaw between(int first, int second, double time = 0) const;
  /// Index, from 0, of the time interval in which laws do not change. There is one interval unless dashpots meet
  /// conditions with `from` or `until`.
  int law_interval(double time) const;
  bool automatic_stiffness(int first, int second) const;
  /// Number of the ContactLawKind; -1: the two bodies never meet.
  std::int32_t kind(int first, int second) const {
    const ContactRule* found = rule(bodies_[first], bodies_[second]);
    return found ? static_cast<std::int32_t>(found->law) : -1;
  }

  double max_reach() const { return max_reach_; }  ///< largest reach of any pair, m
  double largest_stiffness(int body) const;        ///< of any pair with this body, Pa/m
  double largest_damping_ratio(int body) const;    ///< of any pair with this body; 0: no dashpot
  /// Largest number of internal variables per node of any law.
  bool damps() const { return damps_; }                       ///< whether some law has a dashpot
  int group(int body) const { return bodies_[body].group; }   ///< number of the body's group
  double spacing(int body) const { return bodies_[body].h; }  ///< of its outline, m

 private:
  struct Group {
    BodyKind kind;
    int material;
    std::string name;
    double young;               ///< Pa; 0: rigid
    double least_h, largest_h;  ///< outline spacings, m
    double largest_inverse_mass;
    int bodies;
    bool wall;  ///< whether all bodies are walls
  };
  /// Properties of one body on which a law depends besides the rule.
  struct Side {
    int group;
    double h, inverse_mass;
  };

  void add_body(const Model& model, const Body& body);
  void find_rules(const Scene& scene);
  bool meets_itself(const Scene& scene, const Group& group) const;
  void check_restitution(const Scene& scene, const ContactRule& rule, const Group& softer) const;
  void find_extremes();
  void find_eras(const Model& model);
  const ContactRule* rule(const Side& a, const Side& b) const {
    const int index = pair_rule_[static_cast<std::size_t>(a.group) * groups_.size() + b.group];
    return index < 0 ? nullptr : &rules_[index];
  }
  Side extreme(int group, bool finest) const;
  double auto_stiffness(const Side& a, const Side& b) const;
  ContactLaw make_law(const Side& a, const Side& b) const;
  double damping_ratio(const Side& a, const Side& b) const;
  template <class Law>
  ContactLaw with_impact(const Law& law, const ContactRule& rule, const Side& a, const Side& b) const;

  std::string file_;
  std::vector<ContactRule> rules_;
  std::vector<Group> groups_;
  std::vector<Side> bodies_;             ///< inverse masses are the largest at any time
  std::vector<double> interval_starts_;  ///< ascending, s, of all intervals but the first
  /// [intervals][bodies]; empty with a single interval, which has the values of bodies_.
  std::vector<std::vector<double>> interval_inverse_masses_;
  std::vector<int> pair_rule_;  ///< [groups x groups], index in rules_; -1: the pair never meets
  double largest_auto_ = 0, max_reach_ = 0;
  bool damps_ = false;
};

/// Damping ratio z of a linear spring and dashpot that rebound with the restitution e in (0, 1]. With `pull` the force
/// ends at g = 0: e = exp(-pi z / sqrt(1 - z^2)). Without, it ends when it would pull:
/// e = exp(-2 z acos(z) / sqrt(1 - z^2)), for z > 1 with acosh and the root of z^2 - 1.
double damping_ratio(double restitution, bool pull);

}  // namespace pliant
