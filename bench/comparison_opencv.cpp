// SPDX-License-Identifier: MIT
// OpenCV's ANN_MLP on the data that beamgyro_trainer prints:
// beamgyro_opencv rprop|backprop EPOCHS < data. As many trainings as there are
// start weights, but all from its own, always the same (Nguyen-Widrow), and its
// output is a tanh too: it knows no others.
#include <cmath>
#include <ctime>
#include <iostream>
#include <nlohmann/json.hpp>
#include <opencv2/ml.hpp>
#include <string>
#include <vector>

namespace {

using cv::ml::ANN_MLP;
using nlohmann::json;

json train(const json& data, int method, int epochs) {
  const auto sizes = data["layer_sizes"].get<std::vector<int>>();
  const auto inputs = data["inputs"].get<std::vector<std::vector<double>>>();
  const auto target = data["target"].get<std::vector<double>>();
  const auto count = static_cast<int>(target.size());
  cv::Mat x(count, sizes[0], CV_32F), y(count, 1, CV_32F),
      found;  // it takes no other
  for (int k = 0; k < count; ++k) {
    const auto row = static_cast<std::size_t>(k);
    for (int i = 0; i < sizes[0]; ++i)
      x.at<float>(k, i) =
          static_cast<float>(inputs[static_cast<std::size_t>(i)][row]);
    y.at<float>(k, 0) = static_cast<float>(target[row]);
  }
  const cv::Ptr<ANN_MLP> ann = ANN_MLP::create();
  ann->setLayerSizes(sizes);
  ann->setActivationFunction(ANN_MLP::SIGMOID_SYM, 2.0, 1.0);  // tanh
  ann->setTrainMethod(method);
  ann->setTermCriteria(cv::TermCriteria(
      cv::TermCriteria::MAX_ITER + cv::TermCriteria::EPS, epochs, 1e-12));
  const std::clock_t begin = std::clock();
  ann->train(x, cv::ml::ROW_SAMPLE, y);
  const double took =
      static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
  ann->predict(x, found);
  return {{"rms", cv::norm(found, y) / std::sqrt(count)}, {"seconds", took}};
}

}  // namespace

int main(int argc, char** argv) try {
  if (argc != 3) {
    std::cerr << "usage: beamgyro_opencv rprop|backprop EPOCHS < data\n";
    return 2;
  }
  cv::setNumThreads(1);
  const int method =
      std::string(argv[1]) == "rprop" ? ANN_MLP::RPROP : ANN_MLP::BACKPROP;
  const json data = json::parse(std::cin);
  json results = json::array();
  for (std::size_t k = 0; k < data["weights"].size(); ++k)
    results.push_back(train(data, method, std::stoi(argv[2])));
  std::cout << results.dump() << '\n';
  return 0;
} catch (const std::exception& error) {
  std::cerr << error.what() << '\n';
  return 1;
}
