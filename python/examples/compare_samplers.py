"""Which of two samplers plans faster, and how sure is that?"""

import regrasp as rg

if __name__ == "__main__":
    study = rg.compare("sphere", {"sampler": ["rlg", "projection"]}, seeds=15)
    print(study.summary)
    assert study.runs["verified"].all(), "every plan is found and verified"
