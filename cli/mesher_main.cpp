// Makes meshes by Gmsh for `chladni`, which starts it: nothing to be started by hand.
#include "common/confinement/helper_process.hpp"
#include "mesh/gmsh/gmsh.hpp"
#include "sound/gmsh/air.hpp"

int main()
{
  using chladni::Packer;
  using chladni::Unpacker;
  chladni::confinement::serve([](Unpacker& question, Packer& answer) {
    std::string subject;
    question(subject);
    if (subject == "air")
      chladni::sound::answer_with_air(question, answer);
    else
      chladni::mesh::answer(subject, question, answer);
  });
}
